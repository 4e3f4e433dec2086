"""The boxes "Try it" on pages of notebooks: a reader writes a function and checks it in the page.

`boxes.toml` says which task is on which page. `theme/box.html` is a box, `theme/static/try.js` lets
it work, and `theme/static/try_worker.js` runs Python; `lite.checks` makes what that loads.
"""

import tomllib
from collections.abc import Collection
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import nbformat

from hdrlab.course import plan
from hdrlab.course.submissions import reader
from hdrlab.errors import InputError
from hdrlab.show.pages.templates import render_page

HERE = Path(__file__).parent


class Box(NamedTuple):
    """Where the box of a task is, and which packages of Pyodide its checks need beside NumPy."""

    task: str
    notebook: str
    below: str
    packages: tuple[str, ...] = ()


@cache
def read() -> tuple[Box, ...]:
    """Return all boxes of the site."""
    listed = tomllib.loads((HERE / "boxes.toml").read_text("utf-8"))["box"]
    return tuple(Box(**box | {"packages": tuple(box.get("packages", ()))}) for box in listed)


def insert(notebook: Any, name: str, sheets: Collection[str]) -> None:
    """Insert the boxes of a notebook below their cells; a notebook without such a cell gets none."""
    for box in read():
        ids = [cell.get("id") for cell in notebook.cells]
        if box.notebook == name and box.below in ids:
            html = as_html(box, sheets)
            cell = nbformat.v4.new_raw_cell(html, metadata={"format": "text/html"})
            notebook.cells.insert(ids.index(box.below) + 1, cell)


def as_html(box: Box, sheets: Collection[str]) -> str:
    """Return a box as a piece of a page, with a link to its sheet if the site has that."""
    [homework] = [
        homework
        for homework in plan.read().homeworks.values()
        if box.task in [task.id for task in homework.tasks]
    ]
    sheet = homework.name if homework.name in sheets else ""
    stub = stub_of(homework.name, box.task)
    return render_page(HERE / "theme", "box.html", box=box, stub=stub, sheet=sheet)


def stub_of(homework: str, task: str) -> str:
    """Return the stub of a task, as it is in the assignment."""
    for cell in reader.assignment_cells(homework):
        if cell.task == task:
            return cell.text
    raise InputError(f"the assignment of {homework} has no cell for the task {task}")
