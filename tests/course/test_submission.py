"""Reading a submission: its text is parsed and never run."""

import ast
import json
import zipfile

import numpy as np
import pytest

from hdrlab.course.source_code import names
from hdrlab.course.source_code.closure import Cell, extract_sources
from hdrlab.course.submissions import reader

TASKS = ["gsolve", "merge"]


def notebook(*cells, **more):
    """Return a notebook as text; a cell is its source, (source, task), or (source, None) for a given one."""
    listed = []
    for cell in cells:
        source, task = (cell, "")
        if isinstance(cell, tuple):
            source, task = cell
        marks = {}
        if task is None:
            marks["given"] = True
        elif task:
            marks["task"] = task
        listed.append({"cell_type": "code", "source": source, "metadata": {"hdrlab": marks}})
    return json.dumps({"cells": listed, "metadata": {}, "nbformat": 4, **more})


@pytest.fixture
def read(tmp_path):
    """read(text) -> the Submission of a file with this text."""

    def read(text, name="hw.ipynb", given_cells=()):
        file = tmp_path / name
        file.write_bytes(text if isinstance(text, bytes) else text.encode())
        return reader.tasks_of(file, TASKS, given_cells)

    return read


def run(source, name="gsolve"):
    scope = {}
    exec(source, scope)
    return scope[name]


def test_a_function_is_extracted_with_exactly_the_code_that_it_needs(read):
    submission = read(
        notebook(
            "import numpy as np\nfrom hdrlab.capture import scenes\nroom = scenes.room()",
            ("def gsolve(Z):\n    return helper(Z) + K", "gsolve"),
            "def helper(Z):\n    return np.sum(Z) * T[0]\nT = np.zeros(3)\nT[0] = 5",
            "K = 4\nprint(gsolve([1]))\nraise SystemExit",
        )
    )
    source = submission.sources["gsolve"]
    assert run(source)([1, 2]) == 19
    assert "room" not in source and "print" not in source and "SystemExit" not in source


def test_reordered_cells_are_put_in_the_order_in_which_they_run(read):
    submission = read(
        notebook(
            "def gsolve(x=WIDTH):\n    return x",
            "WIDTH = double(4)",
            "def double(x):\n    return 2 * x",
        )
    )
    assert run(submission.sources["gsolve"])() == 8


def test_a_local_name_extracts_no_other_code(read):
    submission = read(
        notebook(
            "Z = load('photographs')",
            "def gsolve(Z):\n    E = [z for z in Z]\n    return E",
            "E = merge()",
        )
    )
    assert "load" not in submission.sources["gsolve"]
    assert "merge" not in submission.sources["gsolve"]


def test_a_task_is_found_by_its_cell_or_by_its_name(read):
    submission = read(
        notebook(
            "def gsolve():\n    return 1",
            ("def gsolve():\n    return 2", "gsolve"),
            "def merge():\n    return 3",
        )
    )
    assert run(submission.sources["gsolve"])() == 2
    assert run(submission.sources["merge"], "merge")() == 3
    assert any("several cells" in problem for problem in submission.problems)


@pytest.mark.parametrize(
    ("order", "counts", "value"),
    [("own other", "that of its own cell", 1), ("other another", "the last one", 3)],
)
def test_a_task_that_is_defined_twice_is_reported_with_the_one_that_counts(
    read, order, counts, value
):
    cells = {
        "own": ("def gsolve():\n    return 1", "gsolve"),
        "other": "def gsolve():\n    return 2",
        "another": "def gsolve():\n    return 3",
    }
    submission = read(notebook(*(cells[name] for name in order.split())))
    assert f"gsolve is defined in several cells; {counts} counts" in submission.problems
    assert run(submission.sources["gsolve"])() == value


def test_given_code_is_taken_from_the_original_assignment(read):
    given_cells = [Cell("def given():\n    return 'ours'", given=True)]
    submission = read(
        notebook(("def given():\n    return 'theirs'", None), "def gsolve():\n    return given()"),
        given_cells=given_cells,
    )
    assert run(submission.sources["gsolve"])() == "ours"


def test_a_students_helper_may_have_the_name_of_a_given_function(read):
    given_cells = [Cell("def given():\n    return 'ours'", given=True)]
    submission = read(
        notebook("def given():\n    return 'own'\ndef gsolve():\n    return given()"),
        given_cells=given_cells,
    )
    assert run(submission.sources["gsolve"])() == "own"


def test_a_broken_cell_affects_only_its_own_functions(read):
    submission = read(notebook(("def gsolve(:\n    pass", "gsolve"), "def merge():\n    return 1"))
    assert set(submission.sources) == {"merge"}
    assert any(
        "cell 1, which holds gsolve, is no Python, line 1" in problem
        for problem in submission.problems
    )
    assert any("gsolve was not found" in problem for problem in submission.problems)


@pytest.mark.parametrize(
    "cell",
    [
        "%matplotlib inline\nimport numpy as np",
        "!pip install something\nimport numpy as np",
        "%%time\nimport numpy as np",
        "import numpy as np\nnp.mean?",
        "import numpy as np; x = 1",
        "try:\n    import numpy as np\nexcept ImportError:\n    np = None",
    ],
)
def test_notebook_magics_are_no_error(read, cell):
    submission = read(notebook(cell, "def gsolve():\n    return np.arange(3)"))
    assert run(submission.sources["gsolve"])().tolist() == [0, 1, 2]
    assert submission.problems == read(notebook("def gsolve():\n    return 1")).problems


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "is empty"),
        (b"\xff\xfe\x00binary", "neither a notebook nor Python text"),
        (b'{"cells": [', "cut short or damaged"),
        (b'{"cells": 7}', "has no cells"),
        (b"[" * 100_000, "not a notebook"),
        (b'{"cells": ' + b"[" * 100_000, "cut short or damaged"),
        (
            b'{"cells": [{"cell_type": "code", "source": 7, "metadata": []}, 5, null]}',
            "gsolve was not found",
        ),
        (
            b'{"cells": [{"cell_type": "code", "source": ["x = ", 7, "1"], "metadata": {"hdrlab": 3}}]}',
            "not found",
        ),
    ],
)
def test_a_file_that_is_no_notebook_is_reported(read, data, message):
    submission = read(data)
    assert not submission.sources and any(message in problem for problem in submission.problems)


def test_a_folder_and_a_missing_file_are_reported(tmp_path):
    for path in (tmp_path, tmp_path / "missing.ipynb"):
        submission = reader.tasks_of(path, TASKS)
        assert not submission.sources and "is not a file" in submission.problems[0]


def test_deeply_nested_code_affects_only_its_cell(read):
    submission = read(
        notebook(
            "x = " + "(" * 5000 + ")" * 5000,
            "y = " + "-" * 50_000 + "1",
            "def gsolve():\n    return 1",
        )
    )
    assert set(submission.sources) == {"gsolve"}


def test_a_python_file_is_read_with_and_without_cells(read):
    plain = "import math\ndef gsolve():\n    return math.pi\n"
    assert run(read(plain, "hw2.py").sources["gsolve"])() == pytest.approx(np.pi)
    percent = (
        '# %% [markdown]\n# gsolve\n# %%\nimport math\n# %% task="gsolve"\n'
        + plain.partition("\n")[2]
    )
    assert run(read(percent, "hw2.py").sources["gsolve"])() == pytest.approx(np.pi)


def test_a_syntax_error_is_reported_with_the_first_line_of_its_cell(read):
    lines = [
        "# %%",
        "import numpy",
        "",
        '# %% task="gsolve"',
        "def gsolve(:",
        "# %%",
        "",
        "x = = 1",
    ]
    problems = read("\n".join(lines), "hw.py").problems
    assert problems[0].startswith("line 4, which holds gsolve, is no Python, line 2")
    assert problems[1].startswith("line 6 is no Python, line 3")


def test_a_submitted_file_is_never_run(read, tmp_path):
    mark = tmp_path / "mark"
    read(
        notebook(f"open({str(mark)!r}, 'w')\nx = open({str(mark)!r}, 'w')\ndef gsolve(): return x")
    )
    assert not mark.exists()


def test_the_same_file_has_the_same_hash_and_another_another(read):
    first = read(notebook("x = 1"))
    again = read(notebook("x = 1"))
    other = read(notebook("x = 2"))
    assert first.hash == again.hash != other.hash


@pytest.mark.parametrize(
    ("code", "free"),
    [
        ("def f(x):\n    global y\n    y = x\n    return y", ["y"]),
        ("def f():\n    for i in a:\n        b = i\n    return b", ["a"]),
        ("def f(x):\n    def g():\n        return x + h\n    return g", ["h"]),
        ("f = lambda x, y=a: x + y", ["a"]),
        ("def f():\n    try:\n        pass\n    except E as e:\n        raise e", ["E"]),
        ("def f(x):\n    match x:\n        case [a, *b]:\n            return a, b, c", ["c"]),
        ("def f(xs):\n    return [y := x for x in xs], y", []),
        ("@a\ndef f(x: b) -> c:\n    return f(x)", ["a", "b", "c", "f"]),
        ("class C(B):\n    x = a", ["B", "a"]),
    ],
)
def test_the_names_that_a_piece_of_code_needs_from_outside_are_found(code, free):
    assert [use.node.id for use in names.free_names(ast.parse(code).body[0])] == free


@pytest.mark.parametrize(
    ("names_in_it", "submission"),
    [
        (["hw2.ipynb"], "hw2.ipynb"),
        (["photo.jpg", "mine.PY"], "mine.PY"),
        (["notes.ipynb", "my HW2.ipynb"], "my HW2.ipynb"),
        (["a.ipynb", "b.ipynb"], None),
        (["photo.jpg"], None),
    ],
)
def test_the_only_notebook_of_an_archive_or_the_one_named_after_the_homework_is_read(
    names_in_it, submission, tmp_path
):
    archive = tmp_path / "handed in.ZIP"
    with zipfile.ZipFile(archive, "w") as opened:
        for name in names_in_it:
            opened.writestr(name, "1 + 1\n")
    path, refused = reader.extract_code_file(archive, tmp_path, "hw2")
    if submission:
        assert (path, refused) == (tmp_path / "files" / submission, "")
    else:
        assert path == archive
        assert refused.startswith("Expected one notebook or Python file in the archive, got ")


def test_a_file_that_is_no_archive_or_is_missing_is_taken_as_it_is(tmp_path):
    for name in ("hw2.ipynb", "missing.zip"):
        assert reader.extract_code_file(tmp_path / name, tmp_path, "hw2") == (tmp_path / name, "")


def test_a_file_with_more_code_than_a_homework_is_refused():
    most = reader.MAX_CODE_CHARACTERS
    assert reader.cells_of(b"#" * most, "hw2.py")[1] == []
    cells, (problem,) = reader.cells_of(b"#" * (most + 1), "hw2.py")
    assert cells == []
    assert "hw2.py has more than 1,000,000 characters" in problem


def test_an_extracted_function_is_defined_before_it_is_called():
    cells = [
        Cell("x, y = g(), 2"),
        Cell("ready = False\ndef g():\n    return y if ready else 5"),
        Cell("def f():\n    return x", task="f"),
    ]
    texts, problems = extract_sources(cells, ["f"])
    own = {}
    exec(texts["f"], own)
    assert own["f"]() == 5 and problems == []
