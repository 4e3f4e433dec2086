"""The site's glossary leads to code and notebooks that exist."""

import importlib
import re
from pathlib import Path

import pytest

import hdrlab

PAGE = Path(hdrlab.__file__).parent / "course/site/pages/glossary.md"
NOTEBOOKS = Path(__file__).parents[1] / "notebooks"
CODE = re.compile(r"\[`([\w.]+)`\]\(reference/([\w.]+)\.rst\)")
ROWS = [
    line
    for line in PAGE.read_text(encoding="utf8").splitlines()
    if line.startswith("| ") and not line.startswith("| term ")
]


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.split("|")[1].strip())
def test_each_term_of_the_glossary_names_code_and_notebooks_that_exist(row):
    ((reference, page),) = CODE.findall(row)
    module, _, name = reference.rpartition(".")
    assert module == page
    assert hasattr(importlib.import_module(f"hdrlab.{module}"), name)
    notebooks = re.findall(r"\]\(notebooks/(\w+\.ipynb)\)", row)
    assert notebooks
    assert [notebook for notebook in notebooks if not (NOTEBOOKS / notebook).exists()] == []


def test_a_term_has_one_row_in_the_glossary():
    terms = [row.split("|")[1].strip() for row in ROWS]
    assert sorted(set(terms)) == sorted(terms)
