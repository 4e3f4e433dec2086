"""Which cells of a notebook a question covers on the site until the reader answers it.

A question covers the outputs of the cells after it, up to and including the first answer that
unfolds. A heading, another question or the end of the notebook ends it earlier. `covers.js` of the
widgets applies the same rule to the cells of a notebook in JupyterLab.
"""

import re
from collections.abc import Iterable, Sequence
from typing import Any

COVERED = "covered"  # tag of a cell with output, class of an answer
ANSWER = re.compile(r"<details(?=[ >])")
QUESTION_OR_HEADING = re.compile(r"\*\*(?:Predict|Think)\.\*\*|^#{1,6} ", re.MULTILINE)


def covered_cells(cells: Sequence[Any], asking: Iterable[int]) -> dict[int, list[int]]:
    """Return the indices of the cells that each question covers.

    Parameters
    ----------
    cells : cells of a notebook
    asking : indices of the cells whose output is a question

    Returns
    -------
    dict
        From the index of each question to those of the cells that it covers, in order.
    """
    questions = set(asking)
    return {index: _cells_after(cells, index, questions) for index in sorted(questions)}


def _cells_after(cells: Sequence[Any], question: int, questions: set[int]) -> list[int]:
    covered = []
    for index in range(question + 1, len(cells)):
        cell = cells[index]
        if index in questions:
            break
        if cell["cell_type"] == "code":
            covered.append(index)
            continue
        text = "".join(cell["source"])
        answer = ANSWER.search(text)
        end = QUESTION_OR_HEADING.search(text)
        if answer is not None and (end is None or answer.start() < end.start()):
            covered.append(index)
            break
        if end is not None:
            break
    return covered


def mark_covered(cells: Sequence[Any], asking: Iterable[int]) -> None:
    """Mark what each question covers: a tag on cells with output, a class on the first answer."""
    for covered in covered_cells(cells, asking).values():
        for cell in (cells[index] for index in covered):
            if cell["cell_type"] == "code":
                cell["metadata"]["tags"] = [*cell["metadata"].get("tags", ()), COVERED]
            else:
                marked = f'<details class="{COVERED}"'
                cell["source"] = ANSWER.sub(marked, "".join(cell["source"]), count=1)
