"""The answers to the exercises: what each file contains, and that only instructors get them.

`test_notebooks_run` runs them.
"""

import re
from pathlib import Path

import nbformat
import pytest
from click.testing import CliRunner

from hdrlab import cli
from hdrlab.course import materials, plan
from hdrlab.course.authoring import handouts
from hdrlab.course.site.lite import wheels

ROOT = Path(__file__).resolve().parents[1]
LESSONS = sorted((ROOT / "notebooks").glob("*.ipynb"))
ANSWERS = ROOT / "solutions" / "exercises"
HEADING = "Answers to the exercises of notebook"  # the first line of each file with answers
MODEL_ANSWER = "**Model answer.**"  # in the notebook of written questions
MAX_LINE_LENGTH = 100

pytestmark = pytest.mark.skipif(
    not ANSWERS.is_dir(), reason="the answers are in a clone, and this is an installed package"
)
each_lesson = pytest.mark.parametrize("lesson", LESSONS, ids=lambda path: path.stem)
each_answer = pytest.mark.parametrize(
    "path", sorted(ANSWERS.glob("*.ipynb")), ids=lambda path: path.stem
)


def texts(path):
    cells = nbformat.read(path, as_version=4).cells
    return [cell.source for cell in cells if cell.cell_type == "markdown"]


def files_with_answers(folder):
    """Return the files below a folder that contain answers to exercises or to written questions."""
    contents = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    marks = (HEADING.encode(), MODEL_ANSWER.encode())
    return [path for path, content in contents.items() if any(mark in content for mark in marks)]


@each_lesson
def test_each_exercise_of_a_lesson_has_one_answer(lesson):
    exercises = "\n".join(texts(lesson)).partition("## Exercises")[2]
    numbers = re.findall(r"^(\d+)\. ", exercises, re.M)
    answers = ANSWERS / lesson.name
    assert answers.is_file(), f"expected the answers to {lesson.name} in {answers}"
    answered = re.findall(r"^## Exercise (\d+): \S", "\n".join(texts(answers)), re.M)
    assert numbers
    assert answered == numbers


def test_there_is_a_lesson_for_each_file_with_answers():
    names = {lesson.name for lesson in LESSONS}
    assert {path.name for path in ANSWERS.iterdir()} <= names


@each_answer
def test_a_file_with_answers_is_a_valid_notebook_without_outputs(path):
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    assert notebook.metadata.kernelspec.name == "python3"
    assert notebook.cells[0].source.startswith(f"# {HEADING} {path.stem[:2]}\n")
    ids = [cell.id for cell in notebook.cells]
    assert len(set(ids)) == len(ids)
    for cell in notebook.cells:
        if cell.cell_type == "code":
            assert (cell.outputs, cell.execution_count) == ([], None), cell.id
            assert max(map(len, cell.source.splitlines())) <= MAX_LINE_LENGTH, cell.id


def test_the_pack_for_instructors_has_all_answers(tmp_path):
    command = ["course", "pack", str(tmp_path / "pack"), "--exercises", str(ANSWERS)]
    ran = CliRunner().invoke(cli.main, command)
    assert ran.exit_code == 0, ran.output
    packed = tmp_path / "pack" / "exercises"
    assert {path.name: path.read_bytes() for path in packed.iterdir()} == {
        path.name: path.read_bytes() for path in ANSWERS.iterdir()
    }
    assert "exercises" in (tmp_path / "pack" / "README.md").read_text("utf-8")


def test_the_pack_without_a_clone_says_where_the_answers_are(tmp_path):
    command = ["course", "pack", str(tmp_path / "pack"), "--exercises", str(tmp_path / "none")]
    ran = CliRunner().invoke(cli.main, command)
    assert ran.exit_code == 0, ran.output
    assert "clone" in ran.output
    assert not (tmp_path / "pack" / "exercises").exists()
    assert "exercises" not in (tmp_path / "pack" / "README.md").read_text("utf-8")


def test_the_files_for_students_have_no_answers(tmp_path):
    """The copy of the course that `hdrlab lab` makes, and the assignments that `build` makes."""
    assert materials.copy_course(tmp_path / "lab")
    assert list(handouts.build_steps(plan.read(), ROOT / "solutions", tmp_path / "built", None))
    assert files_with_answers(tmp_path) == []


def test_what_runs_in_the_browser_of_a_reader_has_no_answers():
    files = wheels.files_of_hdrlab()
    assert any(name.endswith("notebooks/00_welcome.ipynb") for name in files)
    assert [name for name, content in files.items() if HEADING.encode() in content] == []
