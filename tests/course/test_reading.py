"""Reading a submission: limits, a second attempt after an accident, and encodings."""

import codecs
import json
import zipfile
from pathlib import Path

import pytest

from hdrlab.course.sandbox import subprocess_runner
from hdrlab.course.source_code.closure import Cell
from hdrlab.course.submissions import reader
from hdrlab.course.submissions.reader import SubmittedCode

ANSWER = {
    "sources": {"f": "text"},
    "problems": ["a problem"],
    "hash": "digest",
    "modules": ["numpy"],
    "variants": {"f": "a/b"},
}


@pytest.fixture
def tried(monkeypatch):
    """tried(endings...) -> the calls of the attempts to read in a separate process, which end like
    this.
    """

    def tried(*endings):
        left = list(endings)
        calls = []

        def run(work, order, *, timeout, limits):
            assert Path(order[1]).is_dir()
            calls.append((order[0], *order[2:], timeout, limits))
            end = left.pop(0)
            if isinstance(end, Exception):
                raise end
            return json.dumps(end).encode()

        monkeypatch.setattr(subprocess_runner, "run", run)
        return calls

    return tried


def failed(own=False, killed=False):
    made = subprocess_runner.ProcessFailed("it was ended")
    made.is_own_fault = own
    made.was_killed = killed
    return made


@pytest.mark.parametrize("name", ["a.ipynb", "a.py", "a.zip.txt"])
def test_a_file_is_read_in_a_process_with_limited_time_and_memory(name, tried):
    calls = tried(ANSWER)
    submission = reader.read(Path(name), "hw2", ["f", "g"], [Cell("x = 1")])
    assert submission == SubmittedCode(
        {"f": "text"}, ("a problem",), "digest", ("numpy",), {"f": "a/b"}
    )
    ((*order, timeout, limits),) = calls
    assert order == [Path(name), "hw2", ("f", "g"), (Cell("x = 1"),)]
    assert 0 < limits["CPU"] < timeout and 0 < limits["AS"] < 2**30


@pytest.mark.parametrize("name", ["a.zip", "a.tar.GZ", "a.tgz"])
def test_reading_an_archive_may_take_more_processor_time_than_a_notebook(name, tried):
    calls = tried(ANSWER, ANSWER)
    reader.read(Path("a.ipynb"), "hw2", ["f"])
    reader.read(Path(name), "hw2", ["f"])
    notebook_limits = calls[0][-1]
    archive_limits = calls[1][-1]
    assert archive_limits["CPU"] > notebook_limits["CPU"]


def test_a_file_that_exceeds_the_limits_is_reported_and_not_tried_again(tried):
    calls = tried(failed(own=True))
    submission = reader.read(Path("a.zip"), "hw2", [])
    (problem,) = submission.problems
    assert problem.startswith("a.zip") and submission.sources == {} and len(calls) == 1


@pytest.mark.parametrize(
    ("endings", "tries", "read"),
    [
        ([failed(killed=True), ANSWER], 2, True),
        ([failed(killed=True), failed(killed=True), ANSWER], 3, True),
        ([failed(killed=True), failed(killed=True), failed(killed=True), ANSWER], 3, False),
        ([failed(), ANSWER], 1, False),
        ([failed(killed=True), failed(), ANSWER], 2, False),
    ],
)
def test_reading_is_tried_three_times_if_something_kills_it_and_once_if_it_fails(
    endings, tries, read, tried
):
    calls = tried(*endings)
    if read:
        assert reader.read(Path("a.py"), "hw2", []).hash == "digest"
    else:
        with pytest.raises(ValueError, match="it was ended"):
            reader.read(Path("a.py"), "hw2", [])
    assert len(calls) == tries


def test_the_notebook_in_an_archive_is_read(tmp_path):
    text = "import numpy as np\nfrom scipy import ndimage\ndef f():\n    return np.pi, ndimage\n"
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as opened:
        opened.writestr("in/hw2.py", text)
    submission = reader.read(tmp_path / "a.zip", "hw2", ["f"])
    assert submission.sources["f"].endswith("return np.pi, ndimage\n")
    assert submission.problems == () and submission.variants is None
    assert submission.modules == ("numpy", "scipy", "scipy.ndimage") and len(submission.hash) == 64


def test_a_damaged_archive_is_a_problem_and_not_an_error(tmp_path):
    (tmp_path / "b.zip").write_bytes(b"none")
    submission = reader.read(tmp_path / "b.zip", "hw2", ["f"])
    assert submission.sources == {} and submission.hash == "" and len(submission.problems) == 1


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (["a.txt"], "none"),
        (["a.py", "b.ipynb"], "a.py, b.ipynb"),
        ([f"{letter}.py" for letter in "abcdefg"], "a.py, b.py, c.py, d.py, e.py"),
        (["n" * 79 + ".py", "b.py"], "n" * 79 + "\u2026, b.py"),
        (["hw2a.py", "hw2b.py", "c.py"], "hw2a.py, hw2b.py"),
    ],
)
def test_an_archive_with_several_notebooks_or_none_is_refused_with_their_names(
    names, message, tmp_path
):
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as opened:
        for name in names:
            opened.writestr(name, "1")
    path, problem = reader.extract_code_file(tmp_path / "a.zip", tmp_path, "hw2")
    assert path == tmp_path / "a.zip" and message in problem and "g.py" not in problem


# What is in it


@pytest.fixture
def read(tmp_path):
    """read(data) -> the Submission of a file with these bytes."""

    def read(data, *tasks, name="hw.py"):
        (tmp_path / name).write_bytes(data if isinstance(data, bytes) else data.encode())
        return reader.tasks_of(tmp_path / name, tasks)

    return read


def test_a_file_that_is_too_large_is_refused(read, monkeypatch):
    monkeypatch.setattr(reader, "MAX_FILE_BYTES", 7)
    assert read("x = 123").problems == ()
    (problem,) = read("x = 1234").problems
    assert "hw.py" in problem and "clear its outputs" in problem


def test_a_task_with_more_code_than_the_sandbox_takes_is_refused(read, monkeypatch):
    text = "def f(): 1\n"
    monkeypatch.setattr(reader, "MAX_SOURCE_CHARACTERS", len(json.dumps(text)))
    assert read(text, "f").sources == {"f": text}
    monkeypatch.setattr(reader, "MAX_SOURCE_CHARACTERS", len(json.dumps(text)) - 1)
    submission = read(text, "f")
    (problem,) = submission.problems
    assert submission.sources == {} and problem.startswith("f ") and "13" in problem


def test_a_long_list_of_problems_is_cut_and_says_how_many_more_there_are(read):
    names = [f"f{k}" for k in range(reader.MAX_SHOWN_PROBLEMS + 1)]
    (*shown, last) = read("x = 1", *names).problems
    assert [problem.split()[0] for problem in shown] == names[:-1]
    assert "1 more" in last


def test_a_long_problem_is_cut(read):
    (long,) = read("x = 1", "n" * 400).problems
    assert len(long) == reader.MAX_PROBLEM_LENGTH


@pytest.mark.parametrize(
    ("data", "problem"),
    [
        (b"", "hw.py is empty"),
        (b" \n", "hw.py is empty"),
        (b"\xff", "hw.py is neither a notebook nor Python text"),
        (b"# nothing", "f was not found"),
        (b'{"cells": []}', "f was not found"),
        (b'{"cells": 1}', "hw.py has no cells"),
    ],
)
def test_a_file_without_the_task_has_one_problem_that_names_the_cause(data, problem, read):
    (message,) = read(data, "f").problems
    assert message.startswith(problem)


def test_the_variants_of_a_sheet_are_read_from_its_call_of_use_plan(read):
    call = 'use_plan("hw2", {"shift": "cut/goes/rows", "hat": "a b",\n "exclusion":  "compared/above/six"})'
    assert read(call).variants == {"shift": "cut/goes/rows", "exclusion": "compared/above/six"}
    one = 'use_plan("hw4", variants={"display": "factor"})'
    assert read(one).variants == {"display": "factor"}
    assert read('x = {"shift": "cut/goes/rows"}').variants is None
    assert read("use_plan()\n# %%\nx = {'a': 1}").variants == {}


@pytest.mark.parametrize(
    "data",
    [
        "x = '\u00e9'".encode(),
        codecs.BOM_UTF8 + "x = '\u00e9'".encode(),
        "x = '\u00e9'".encode("utf-16"),
        codecs.BOM_UTF16_BE + "x = '\u00e9'".encode("utf-16-be"),
        "# coding: latin-1\nx = '\u00e9'".encode("latin-1"),
        '  {"cells": [{"cell_type": "code", "source": "# coding: latin-1\\nx = \'\u00e9\'"}]}'.encode(),
    ],
)
def test_text_is_decoded_by_its_byte_order_mark_or_coding_comment_or_as_utf8(data):
    (cell,), problems = reader.cells_of(data, "hw")
    assert cell.text.endswith("x = '\u00e9'") and not problems


def test_a_python_file_in_percent_format_has_a_cell_for_each_fence():
    text = "a = 1\n\n# %%\nb = 2\n# %% [markdown]\n# words\n# %% [raw]\nr\n"
    text += '# %% task="f" given="yes"\n\nc = 3\n# %%\n'
    assert reader.cells_of(text.encode(), "hw.py") == (
        [
            Cell("a = 1\n\n", "", False, "the beginning of the file"),
            Cell("\nb = 2\n", "", False, "line 3"),
            Cell("\n\nc = 3\n", "f", True, "line 9"),
        ],
        [],
    )
    assert reader.cells_of(b"\n# %%\nb", "hw.ipynb") == (
        [Cell("\nb", "", False, "line 2")],
        ["hw.ipynb is not a notebook; hdrlab read it as Python text"],
    )


def test_a_notebook_with_wrong_types_in_its_cells_is_read():
    code = {"cell_type": "code"}
    cells = [
        {"cell_type": "markdown", "source": "words"},
        code | {"source": ["a\n", "b"], "metadata": {"hdrlab": {"task": "f", "given": True}}},
        7,
        code | {"source": "c", "metadata": {"hdrlab": {"task": 1, "given": 1}}},
        code | {"input": "d", "metadata": {"hdrlab": "f"}},
        code | {"source": None, "metadata": "f"},
    ]
    submissions = [
        Cell("a\nb", "f", True, "cell 2"),
        Cell("c", "", False, "cell 4"),
        Cell("d", "", False, "cell 5"),
    ]
    submissions.append(Cell("", "", False, "cell 6"))
    assert reader.cells_of(json.dumps({"cells": cells}).encode(), "a.ipynb") == (submissions, [])
    old = {"worksheets": [{"cells": cells[:2]}, {"cells": 7}, 8]}
    assert reader.cells_of(json.dumps(old).encode(), "a.ipynb") == ([submissions[0]], [])


def test_half_a_character_in_a_comment_loses_no_cell():
    source = "# a broken \ud83d comment, a whole \U0001f600\ndef hat(n): return n\n"
    cell = {"cell_type": "code", "source": source}
    ((cell_read,), problems) = reader.cells_of(json.dumps({"cells": [cell]}).encode(), "a.ipynb")
    assert problems == [] and "def hat" in cell_read.text and "\U0001f600" in cell_read.text
    assert cell_read.text.encode("utf8")


@pytest.mark.parametrize("content", [{"cells": {}}, {"worksheets": 1}, {}])
def test_a_json_file_without_a_list_of_cells_is_no_notebook(content):
    cells, (problem,) = reader.cells_of(json.dumps(content).encode(), "a.ipynb")
    assert cells == []
    assert "a.ipynb has no cells" in problem
