"""A notebook links a paper where it first cites it."""

import json
import re

import pytest
from support.paper_links import PAPERS
from test_notebooks import NOTEBOOKS


def prose(path):
    """Return the text of a notebook, without its code."""
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return "\n\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "markdown")


def mentions(text, pattern):
    return list(re.finditer(pattern.replace(" ", r"\s+"), text))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_the_first_mention_of_a_paper_carries_its_link(path):
    text = prose(path)
    for pattern, address in PAPERS.items():
        for first in mentions(text, pattern)[:1]:
            assert text[first.end() :].startswith(f"]({address})"), first.group()


def test_each_paper_of_the_table_is_named_in_a_notebook():
    texts = [prose(path) for path in NOTEBOOKS]
    assert [
        pattern for pattern in PAPERS if not any(mentions(text, pattern) for text in texts)
    ] == []
