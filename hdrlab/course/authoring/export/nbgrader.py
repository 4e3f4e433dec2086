"""A course for nbgrader: source notebooks that its own `generate_assignment` and `autograde` accept.

The solution of a task stands inside its function, between nbgrader's marks, helpers and all, so
that the student's version keeps signature and docstring. A test cell calls `check`, and its last
line is a number: the points, which nbgrader takes for partial credit.

nbgrader runs a student's cells in the very kernel that runs the test cells. Our checks call the
functions in another process, but what stands around them in that kernel can be tampered with: where
grades count among strangers, grade with `hdrlab grade` and its strict tier.
"""

import ast
import json
import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hdrlab.course import materials
from hdrlab.course.authoring import handouts, stubs
from hdrlab.course.plan import Homework, Plan, Task
from hdrlab.course.source_code import inline
from hdrlab.course.submissions import reader
from hdrlab.errors import InputError

SCHEMA = 3  # of nbgrader's metadata, which 0.6 to 0.9 write
CONFIG = Path(__file__).parent / "nbgrader_config.txt"  # in nbgrader's own language


def export(plan: Plan, folder: Path) -> Iterator[Path]:
    """Write the course into a folder, and yield each file when it is there.

    Parameters
    ----------
    plan : what is in each homework; its notebooks are those in `assignments`
    folder : made where it is missing
    """
    for name, homework in plan.homeworks.items():
        handout = materials.folder("assignments") / f"{name}.ipynb"
        if not handout.is_file():
            raise InputError(f"no assignment {handout}; run hdrlab course build first")
        notebook = source(json.loads(handout.read_text(encoding="utf8")), homework)
        yield handouts.write_text(folder / "source" / name / f"{name}.ipynb", notebook)
    yield handouts.write_text(folder / "nbgrader_config.py", CONFIG.read_text(encoding="utf8"))


def source(handout: dict[str, Any], homework: Homework) -> str:
    """Return a handout as nbgrader's source notebook: with solutions, points and locks."""
    tasks = {task.id: task for task in homework.tasks}
    cells = [_cell({**cell, "source": "".join(cell["source"])}, tasks) for cell in handout["cells"]]
    missing = set(tasks) - {
        one.task for one in reader.cells_of(json.dumps(handout).encode(), "")[0]
    }
    if missing:
        raise InputError(
            f"the assignment {homework.name} has no {', '.join(sorted(missing))}; "
            "run hdrlab course build again"
        )
    return handouts.to_text({**handout, "cells": [cell for cell in cells if cell is not None]})


def _cell(cell: dict[str, Any], tasks: dict[str, Task]) -> dict[str, Any] | None:
    """Return a cell with nbgrader's marks; None for those of a task that the plan leaves out."""
    kind, _, name = cell["id"].partition("-")
    if cell["cell_type"] != "code" or kind not in ("task", "check"):
        return cell
    if name not in tasks:
        return None
    asks, points = kind == "check", tasks[name].points
    marks = {"grade_id": cell["id"], "schema_version": SCHEMA, "task": False, "solution": not asks}
    marks |= {"grade": asks, "locked": asks} | ({"points": points} if asks else {})
    asked = f'found = check("{name}", worth={points:g})\ndisplay(found)\nfound.points'
    text = asked if asks else solved(tasks[name])
    return {**cell, "metadata": {**cell["metadata"], "nbgrader": marks}, "source": text}


def solved(task: Task) -> str:
    """Return a task's function with its solution between nbgrader's marks.

    Examples
    --------
    >>> solved(Task("count", "capture.planning.count", 10)).splitlines()[2:4]
    ['    ### BEGIN SOLUTION', '    import math']
    """
    head, block = (
        stubs.stub(task).rpartition("\n")[0],
        inline.inlined({task.id: task.function})[task.id],
    )
    around = "\n\n".join(filter(None, ("\n".join(block.imports), block.needs)))
    inside = "\n".join(filter(None, (textwrap.indent(around, "    "), _body(block.source))))
    return f"{head}\n    ### BEGIN SOLUTION\n{inside}\n    ### END SOLUTION"


def _body(source: str) -> str:
    """Return the lines of a function below its docstring."""
    (node,) = ast.parse(source).body
    assert isinstance(node, ast.FunctionDef)
    first = node.body[0].end_lineno if ast.get_docstring(node) else node.body[0].lineno - 1
    return "\n".join(source.splitlines()[first:])
