"""Every notebook is run once, from the top; what came of it is kept for the pages that show it.

So are the answers to the exercises, which are shown nowhere.
"""

from pathlib import Path

import nbformat
import pytest
from test_notebooks import NOTEBOOKS

from hdrlab.course.authoring import execute

ANSWERS = sorted((Path(__file__).parents[1] / "solutions" / "exercises").glob("*.ipynb"))
pytestmark = pytest.mark.notebooks

LONG = (
    "13",
    "02",
    "17",
    "09",
)  # these are begun first: begun last, one would be run while a worker stands by


@pytest.fixture(
    scope="module",
    params=sorted(NOTEBOOKS, key=lambda path: path.stem[:2] not in LONG),
    ids=lambda path: path.stem,
)
def ran(request, executed):
    """All tests of a notebook come one after the other, and so with one worker."""
    return executed(request.param)


def assert_ran_without_complaint(executed_notebook):
    notebook = nbformat.read(executed_notebook, as_version=4)
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    outputs = [output for cell in cells for output in cell.outputs]
    assert all(cell.execution_count for cell in cells if cell.source.strip())
    assert [
        one for one in outputs if one.output_type == "error" or one.get("name") == "stderr"
    ] == []


def test_every_cell_of_a_notebook_runs_and_none_complains(ran):
    assert_ran_without_complaint(ran.executed)


def test_what_a_notebook_says_of_its_own_numbers_is_true(ran):
    assert ran.untrue == []


def test_each_slider_answers_when_all_cells_have_run(ran):
    assert ran.unanswered == []


@pytest.mark.parametrize("answers", ANSWERS, ids=lambda path: path.stem)
def test_every_cell_of_the_answers_to_exercises_runs_and_none_complains(answers, tmp_path):
    (done,) = execute.run_steps([answers], tmp_path, jobs=1)
    assert_ran_without_complaint(done.executed)
