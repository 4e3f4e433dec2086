"""The source of a task with all definitions that it needs, in a working order."""

import pytest

from hdrlab.course.source_code import closure
from hdrlab.course.source_code.closure import Cell, extract_sources

F = "def f():\n    return x"


def source(*cells, task="f"):
    """Return the statements of a task's text; the last cell belongs to the task itself."""
    made = [Cell(text) for text in cells[:-1]] + [Cell(cells[-1], task)]
    texts, problems = extract_sources(made, [task])
    assert not problems
    assert texts[task].endswith("\n") and not texts[task].endswith("\n\n")
    return texts[task].removesuffix("\n").split("\n\n")


def run(statements):
    scope = {}
    exec("\n\n".join(statements), scope)
    return scope["f"]()


@pytest.mark.parametrize(
    ("cells", "expected"),
    [
        (("x = 1; y = 2", F), ["x = 1", F]),
        (("y = 2; x = y + 1", F), ["y = 2", "x = y + 1", F]),
        (("y = 2;  x = {\n  'a': y}", F), ["y = 2", "x = {\n  'a': y}", F]),
        (("\u00e9 = '\u00e9'; x = \u00e9", F), ["\u00e9 = '\u00e9'", "x = \u00e9", F]),
        (("z = 1\nx = 7\nprint(x)\nx", F), ["x = 7", F]),
        (("import os\nx = os.sep", F), ["import os", "x = os.sep", F]),
        (("x = sep", "from os import sep", F), ["from os import sep", "x = sep", F]),
        (
            ("from numpy import *\nfrom scipy.linalg import *", F),
            ["from numpy import *", "from scipy.linalg import *", F],
        ),
        (("from secrets import *\nx = 1", F), ["x = 1", F]),
        (("import math as m\nimport math as x", F), ["import math as x", F]),
        (("x = 1", "import os as x", F), ["import os as x", F]),
        (("import os as x", "x.sep = 1", F), ["import os as x", F]),
    ],
)
def test_only_needed_statements_of_other_cells_are_taken_with_imports_first(cells, expected):
    assert source(*cells) == expected


DECORATED = "@wrap\n@wrap\ndef x():\n    return 1"
WRAP = "def wrap(g):\n    return g"


@pytest.mark.parametrize(
    ("cells", "expected"),
    [
        ((WRAP, DECORATED, F), [WRAP, DECORATED, F]),
        ((DECORATED, WRAP, F), [WRAP, DECORATED, F]),
        (("def x():\n    return 1", "def x():\n    return 2", F), ["def x():\n    return 2", F]),
        (("class x:\n    a = 1", "class x:\n    a = 2", F), ["class x:\n    a = 2", F]),
        (
            ("async def x():\n    return 1", "async def x():\n    return 2", F),
            ["async def x():\n    return 2", F],
        ),
        (
            ("@int\ndef x():\n    return 1", "x = 2", F),
            ["@int\ndef x():\n    return 1", "x = 2", F],
        ),
        (("x = 0", "def x(): 1", "x.a = 1", F), ["def x(): 1", "x.a = 1", F]),
        (
            ("x.a = 0", "def x(): 1", "x.a = 1", "x.b = 2", F),
            ["def x(): 1", "x.a = 1", "x.b = 2", F],
        ),
        (("def x(): 0", "x.a = 0", "def x(): 1", "x.a = 1", F), ["def x(): 1", "x.a = 1", F]),
        (("x = 1", "x = x + 1", "x *= 3", F), ["x = 1", "x = x + 1", "x *= 3", F]),
        (
            ("x = [1]", "x.append(2)", "x[0] = 3", "x.a.b[1] = 3", F),
            ["x = [1]", "x.append(2)", "x[0] = 3", "x.a.b[1] = 3", F],
        ),
        (("for k in range(3):\n    x = k", F), ["for k in range(3):\n    x = k", F]),
        (("k = 9", "for k in range(3):\n    x = k", F), ["for k in range(3):\n    x = k", F]),
    ],
)
def test_all_assignments_that_affect_a_value_are_taken(cells, expected):
    assert source(*cells) == expected


def test_a_helper_in_the_cell_of_the_task_takes_precedence():
    own = f"def x():\n    return 'own'\n\n{F}"
    for cells in ((own, "def x():\n    return 'other'"), ("def x():\n    return 'other'", own)):
        made = [Cell(text, "f" if text is own else "") for text in cells]
        assert extract_sources(made, ["f"])[0]["f"] == f"def x():\n    return 'own'\n\n{F}\n"
    assert source("def x():\n    return 1", "def x():\n    return 2", F)[0].endswith("2")


def test_functions_keep_their_order_unless_a_statement_calls_them_at_once():
    g = "def g():\n    return 1"
    assert source("def h():\n    return g()", g, "def f():\n    return h()") == [
        "def h():\n    return g()",
        g,
        "def f():\n    return h()",
    ]
    assert source("x = g()", g, F) == [g, "x = g()", F]


def test_a_call_comes_after_everything_that_the_called_function_reads():
    cells = ("x = g()", "def g():\n    return list(y)", "y = [1]", "y.append(2)", "y.append(3)", F)
    assert run(source(*cells)) == [1, 2, 3]
    cells = (
        "x = g()",
        "def g():\n    return h()",
        "def h():\n    return a + b",
        "a = 1",
        "a += 1",
        "b = a",
        F,
    )
    assert run(source(*cells)) == 4


def test_an_invalid_escape_in_a_string_is_kept():
    assert source("x = '\\d'", F) == ["x = '\\d'", F]


@pytest.mark.parametrize("end", ["\n", "\r", "\r\n"])
def test_any_line_ending_and_a_form_feed_are_accepted(end):
    assert source(f"x = 1{end}y = 2\x0c{end}x = x + y", F) == ["x = 1", "y = 2", "x = x + y", F]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("x = 1", "x = 1"),
        ("  x = 1\n  y = 2", "x = 1\ny = 2"),
        ("%%time\nx = 1", "x = 1"),
        ("%%script python\nx = 1", "x = 1"),
        ("%%bash\nls", ""),
        ("\n%%html\n<p>", ""),
        ("if x:\n    %timeit f\n    !ls\ny?\n?y", "if x:\n    pass\n    pass\npass\npass"),
        ("s = '''\n%time\n'''", "s = '''\n%time\n'''"),
        ("s = 5 \\\n% 3", "s = 5 \\\n% 3"),
        ("x = 1 ? \r\ny", "pass\ny"),
        ("x = (\n%time", "x = (\npass"),
    ],
)
def test_notebook_magics_are_removed_from_a_cell(text, expected):
    assert closure.plain(text) == expected


def test_given_cells_replace_their_copies_in_the_assignment_and_do_not_count_as_answers():
    given_cells = [Cell("x = 'ours'", given=True), Cell("def f():\n    return 'ours'", "f", True)]
    cells = [Cell("x = 'theirs'", given=True), Cell(F, "f")]
    assert extract_sources(cells, ["f"], given_cells)[0]["f"] == f"x = 'ours'\n\n{F}\n"
    assert extract_sources(cells, ["f"])[0]["f"] == f"x = 'theirs'\n\n{F}\n"
    assert extract_sources(cells[:1], ["f"], given_cells) == (
        {},
        ["f was not found: no cell defines a function of this name"],
    )


@pytest.mark.parametrize(
    ("cell", "message"),
    [
        (Cell("x = = 1", "", False, "cell 3"), "cell 3 is no Python, line 1: "),
        (
            Cell("x = 1\ny = = 1", "f", False, "cell 4"),
            "cell 4, which holds f, is no Python, line 2: ",
        ),
        (Cell("x = = 1", "g", False, "cell 5"), "cell 5 is no Python, line 1: "),
        (Cell("x = '\0'", "", False, "cell 6"), "cell 6 is no Python"),
    ],
)
def test_a_cell_with_a_syntax_error_is_reported_with_its_line(cell, message):
    texts, problems = extract_sources([cell, Cell("def f(): 1")], ["f"])
    assert texts == {"f": "def f(): 1\n"} and len(problems) == 1 and problems[0].startswith(message)
