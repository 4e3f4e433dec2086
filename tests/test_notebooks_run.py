"""Every notebook is run once, from the top; what came of it is kept for the pages that show it."""

import nbformat
import pytest
from test_notebooks import NOTEBOOKS


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_every_cell_of_a_notebook_runs_and_none_complains(path, executed):
    cells = [cell for cell in nbformat.read(executed(path), as_version=4).cells if cell.cell_type == "code"]
    outputs = [output for cell in cells for output in cell.outputs]
    assert all(cell.execution_count for cell in cells if cell.source.strip())
    assert [one for one in outputs if one.output_type == "error" or one.get("name") == "stderr"] == []
