"""Handouts filled in, rightly or with a well-known mistake, and the pack of model solutions for instructors.

What is right is the library's own function, that of the library that is installed, and a mistake changes it.
Neither the wheel nor the source distribution holds the pack.
"""

import json
from collections.abc import Iterable, Iterator, Mapping
from functools import reduce
from pathlib import Path
from typing import Any

from hdrlab.course.checks.misconceptions import put_in, solutions, task_of
from hdrlab.course.material import handouts, materials
from hdrlab.course.plan import Homework, Plan

FENCE = "\n\n\n# %%\n"
HEAD = Path(__file__).with_name("solutions_head.md")  # of the table of what is in the pack


def texts(homework: Homework, mistakes: Iterable[str] = ()) -> dict[str, str]:
    """Return what stands in the cell of each task.

    Parameters
    ----------
    homework : whose tasks
    mistakes : names of mistakes, at most one for each task; the other tasks are right

    Examples
    --------
    >>> from hdrlab.course import plan
    >>> cells = texts(plan.read().homeworks["hw2"], ["gsolve_lambda_read_as_1"])
    >>> "smoothness * w[z]" in cells["gsolve"], "hdrlab" in "".join(cells.values())
    (False, False)
    """
    variant = {task.id: task.variant for task in homework.tasks}
    cells = dict(solutions(homework.tasks))
    return reduce(lambda cells, name: put_in(cells, name, variant[task_of(name)]), mistakes, cells)


def notebook(homework: Homework, cells: Mapping[str, str] | None = None) -> str:
    """Return the handout as a file holds it, with these texts in place of stubs; without any it is blank."""
    file = materials.folder("assignments") / f"{homework.name}.ipynb"
    handout: dict[str, Any] = json.loads(file.read_text(encoding="utf8"))
    filled = []
    for cell in handout["cells"]:
        task = cell["metadata"].get("hdrlab", {}).get("task", "")
        filled.append({**cell, "source": (cells or {}).get(task, "".join(cell["source"]))})
    return handouts.to_text({**handout, "cells": filled})


def script(cells: Mapping[str, str]) -> str:
    """Return the same as a Python file in the percent form, as an editor would save it."""
    return "# %%\n" + FENCE.join(cells.values()) + "\n"


def write(plan: Plan, folder: Path) -> Iterator[Path]:
    """Write the pack into a folder, which is made where it is missing, and yield each file."""
    table = HEAD.read_text("utf8")
    for name, homework in plan.homeworks.items():
        cells = texts(homework)
        yield handouts.write_text(folder / f"{name}.py", script(cells))
        if not any(task.own for task in homework.tasks):  # whose sheet stands elsewhere
            yield handouts.write_text(folder / f"{name}.ipynb", notebook(homework, cells))
        for task in homework.tasks:
            lines = len(cells[task.id].splitlines())
            table += f"| {name} | `{task.id}` | {task.points:g} | {lines} | `{task.function}` |\n"
    yield handouts.write_text(folder / "README.md", table)
