"""Every notebook runs from its first cell to its last without an error or a warning.

So do the answers to the exercises. The executed notebooks are kept for the tests of the site.
"""

from pathlib import Path

import nbformat
import pytest
from test_notebooks import NOTEBOOKS

from hdrlab.course.authoring import execute

ANSWERS = sorted((Path(__file__).parents[1] / "solutions" / "exercises").glob("*.ipynb"))
pytestmark = pytest.mark.notebooks

# These take longest and start first; otherwise one worker would run one of them while the other waits.
LONG_NOTEBOOKS = ("13", "02", "17", "09")


@pytest.fixture(
    scope="module",
    params=sorted(NOTEBOOKS, key=lambda path: path.stem[:2] not in LONG_NOTEBOOKS),
    ids=lambda path: path.stem,
)
def run(request, execute_notebook):
    """Return the NotebookRun of a notebook; its tests follow one another in the same worker."""
    return execute_notebook(request.param)


def assert_ran_without_errors_or_warnings(path):
    notebook = nbformat.read(path, as_version=4)
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    outputs = [output for cell in cells for output in cell.outputs]
    assert all(cell.execution_count for cell in cells if cell.source.strip())
    assert [output for output in outputs if output.output_type == "error"] == []
    assert [output for output in outputs if output.get("name") == "stderr"] == []


def test_every_cell_of_a_notebook_runs_without_errors_or_warnings(run):
    assert_ran_without_errors_or_warnings(run.path)


def test_the_sentences_of_a_notebook_about_its_numbers_are_true(run):
    assert run.false_sentences == []


def test_each_slider_works_after_all_cells_have_run(run):
    assert run.broken_sliders == []


@pytest.mark.parametrize("answers", ANSWERS, ids=lambda path: path.stem)
def test_every_cell_of_the_answers_to_exercises_runs_without_errors_or_warnings(answers, tmp_path):
    (executed,) = execute.run_steps([answers], tmp_path, jobs=1)
    assert_ran_without_errors_or_warnings(executed.executed)
