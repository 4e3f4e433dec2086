"""The welcome notebook links to every other notebook, and all links work."""

import re
from pathlib import Path

import nbformat

FOLDER = Path(__file__).parents[1] / "notebooks"


def links_of(path):
    cells = nbformat.read(path, as_version=4).cells
    text = "\n".join(cell.source for cell in cells if cell.cell_type == "markdown")
    return set(re.findall(r"\]\((\d\d_\w+\.ipynb)\)", text))


def test_the_welcome_notebook_leads_to_every_other_one():
    others = {path.name for path in FOLDER.glob("*.ipynb")} - {"00_welcome.ipynb"}
    assert others - links_of(FOLDER / "00_welcome.ipynb") == set()


def test_no_notebook_links_to_one_that_is_missing():
    for path in FOLDER.glob("*.ipynb"):
        assert [name for name in links_of(path) if not (FOLDER / name).exists()] == [], path.name
