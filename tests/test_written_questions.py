"""The written questions: every number of a model answer is computed, and students get no answer."""

import contextlib
import io
import re
from pathlib import Path

import nbformat
import pytest
from click.testing import CliRunner

from hdrlab import cli
from hdrlab.course.authoring import solutions

ROOT = Path(__file__).resolve().parents[1]
FILE = ROOT / "solutions" / "written_questions.ipynb"
TITLE = re.compile(r"## (\d+) · (.+) \((\d+) points\)\n")
MARK = re.compile(r"^- (\d+): ", re.M)
# a number that somebody has to compute: with decimals, in per cent, or of four digits or more
COMPUTED = re.compile(r"(?<![\d.^{/])\d+\.\d+|\d+(?=%)|(?<![\d.^{])\d{4,}")

pytestmark = [
    pytest.mark.papers,
    pytest.mark.skipif(
        not FILE.is_file(), reason="the answers are in a clone, and this is an installed package"
    ),
]


def is_for_instructors(cell):
    return solutions.INSTRUCTOR_TAG in cell.metadata.get("tags", ())


@pytest.fixture(scope="module")
def questions():
    """Each question with its answer and what its code prints, by its title."""
    notebook = nbformat.read(FILE, as_version=4)
    nbformat.validate(notebook)
    scope = {}
    _, _, setup, *cells = notebook.cells
    exec(setup.source, scope)
    found = {}
    for question, answer, code in zip(cells[::3], cells[1::3], cells[2::3], strict=True):
        assert not is_for_instructors(question)
        assert is_for_instructors(answer) and is_for_instructors(code)
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(code.source, scope)
        found[question.source.splitlines()[0]] = (question, answer.source, printed.getvalue())
    return found


def test_the_questions_are_numbered_and_their_marks_add_up_to_their_points(questions):
    assert 12 <= len(questions) <= 20
    total = 0
    for number, (question, answer, _) in enumerate(questions.values(), 1):
        title = TITLE.match(question.source)
        assert int(title[1]) == number
        text, marking = answer.split("**Marking.**")
        assert text.startswith("**Model answer.** ") and len(text.split()) <= 160, title[2]
        assert sum(map(int, MARK.findall(marking))) == int(title[3]), title[2]
        total += int(title[3])
    first = nbformat.read(FILE, as_version=4).cells[0].source
    assert f"{len(questions)} questions, {total} points" in " ".join(first.split())
    page = ROOT / "hdrlab" / "course" / "site" / "pages" / "teaching.md"
    described = f"{len(questions)} questions with their points, {total} in total"
    assert described in page.read_text("utf8")


def test_every_number_of_a_model_answer_is_given_or_computed_by_its_code(questions):
    for title, (question, answer, printed) in questions.items():
        text = answer.split("**Marking.**")[0]
        numbers = COMPUTED.findall(re.sub(r"(?<=\d),(?=\d{3})", "", text))
        given = question.source.replace(",", "")
        for number in numbers:
            pattern = rf"(?<![\d.]){re.escape(number)}(?![\d])"
            assert re.search(pattern, printed) or re.search(pattern, given), f"{title}: {number}"


def test_the_sheet_for_students_has_all_questions_and_no_answer(questions):
    sheet = solutions.written_sheet(FILE.read_text("utf8"))
    for question, answer, _ in questions.values():
        assert question.source in sheet
        sentences = re.split(r"(?<=[.])\s+", answer.split("**Marking.**")[0])
        assert not any(sentence in sheet for sentence in sentences if len(sentence) > 20)
    for word in ("Model answer", "Marking", "instructor", "import numpy"):
        assert word not in sheet


def test_the_pack_has_the_questions_with_answers_and_the_sheet(tmp_path):
    command = ["course", "pack", str(tmp_path), "--written", str(FILE)]
    ran = CliRunner().invoke(cli.main, command)
    assert ran.exit_code == 0, ran.output
    assert (tmp_path / FILE.name).read_bytes() == FILE.read_bytes()
    assert "Model answer" not in (tmp_path / solutions.WRITTEN_SHEET).read_text("utf8")
    assert solutions.WRITTEN_SHEET in (tmp_path / "README.md").read_text("utf8")


def test_the_pack_without_a_clone_says_that_the_questions_are_missing(tmp_path):
    command = ["course", "pack", str(tmp_path / "pack"), "--written", str(tmp_path / "none.ipynb")]
    ran = CliRunner().invoke(cli.main, command)
    assert ran.exit_code == 0 and "--written" in ran.output
    assert not (tmp_path / "pack" / solutions.WRITTEN_SHEET).exists()
