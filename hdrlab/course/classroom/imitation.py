"""What students hand in, imitated: the handout filled in, rightly or with a well-known mistake.

What is right is the library's own function, and a mistake changes it.
"""

import json
from collections.abc import Iterable, Mapping
from functools import reduce
from typing import Any

from hdrlab.course.checks.misconceptions import put_in, solutions, task_of
from hdrlab.course.material import handouts, materials
from hdrlab.course.plan import Homework

FENCE = "\n\n\n# %%\n"


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
