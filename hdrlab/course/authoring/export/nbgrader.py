"""Export the course for nbgrader, as source notebooks for its `generate_assignment` and `autograde`.

The solution of a task is inside its function, between nbgrader's marks, with its helpers. So the
student's version keeps signature and docstring. A test cell calls `check`, and its last line is the
number of points, which nbgrader takes for partial credit.

nbgrader runs a student's cells in the same kernel as the test cells. hdrlab's checks call the
functions in another process, but a student's cells can tamper with everything around them in that
kernel. Where students may try that, grade with `hdrlab grade` and its strict tier.
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

# version of nbgrader's metadata, which nbgrader 0.6 to 0.9 write
METADATA_SCHEMA_VERSION = 3
CONFIG_TEMPLATE = Path(__file__).parent / "nbgrader_config.txt"
BEGIN_SOLUTION = "    ### BEGIN SOLUTION"
END_SOLUTION = "    ### END SOLUTION"


def export(plan: Plan, folder: Path) -> Iterator[Path]:
    """Write the course into a folder, and yield each file once it is written.

    Parameters
    ----------
    plan : the homeworks; their notebooks are those in `assignments`
    folder : the folder, which is made if it is missing
    """
    for name, homework in plan.homeworks.items():
        handout = materials.folder("assignments") / f"{name}.ipynb"
        if not handout.is_file():
            raise InputError(f"no assignment {handout}; run hdrlab course build first")
        notebook = source(json.loads(handout.read_text(encoding="utf8")), homework)
        yield handouts.write_text(folder / "source" / name / f"{name}.ipynb", notebook)
    config = CONFIG_TEMPLATE.read_text(encoding="utf8")
    yield handouts.write_text(folder / "nbgrader_config.py", config)


def source(handout: dict[str, Any], homework: Homework) -> str:
    """Return a handout as nbgrader's source notebook, with solutions, points and locked cells."""
    tasks = {task.id: task for task in homework.tasks}
    cells = []
    for cell in handout["cells"]:
        marked = _mark_cell({**cell, "source": "".join(cell["source"])}, tasks)
        if marked is not None:
            cells.append(marked)
    handout_cells, _ = reader.cells_of(json.dumps(handout).encode(), "")
    missing = set(tasks) - {cell.task for cell in handout_cells}
    if missing:
        names = ", ".join(sorted(missing))
        raise InputError(
            f"the assignment {homework.name} has no {names}; run hdrlab course build again"
        )
    return handouts.to_text({**handout, "cells": cells})


def _mark_cell(cell: dict[str, Any], tasks: dict[str, Task]) -> dict[str, Any] | None:
    """Return a cell with nbgrader's marks; None for a cell of a task that is not in the plan."""
    kind, _, name = cell["id"].partition("-")
    if cell["cell_type"] != "code" or kind not in ("task", "check"):
        return cell
    if name not in tasks:
        return None
    is_check = kind == "check"
    marks: dict[str, Any] = {
        "grade_id": cell["id"],
        "schema_version": METADATA_SCHEMA_VERSION,
        "task": False,
        "solution": not is_check,
        "grade": is_check,
        "locked": is_check,
    }
    if is_check:
        points = tasks[name].points
        marks["points"] = points
        text = f'found = check("{name}", worth={points:g})\ndisplay(found)\nfound.points'
    else:
        text = solved(tasks[name])
    return {**cell, "metadata": {**cell["metadata"], "nbgrader": marks}, "source": text}


def solved(task: Task) -> str:
    """Return a task's function with its solution between nbgrader's marks.

    Examples
    --------
    >>> solved(Task("count", "capture.planning.count", 10)).splitlines()[2:4]
    ['    ### BEGIN SOLUTION', '    import math']
    """
    # the stub without its last line, which raises NotImplementedError
    signature, _, _ = stubs.stub(task).rpartition("\n")
    block = inline.inlined({task.id: task.function})[task.id]
    helpers = "\n\n".join(part for part in ("\n".join(block.imports), block.needs) if part)
    solution = [part for part in (textwrap.indent(helpers, "    "), _body(block.source)) if part]
    return "\n".join([signature, BEGIN_SOLUTION, *solution, END_SOLUTION])


def _body(function: str) -> str:
    """Return the lines of a function below its docstring."""
    (node,) = ast.parse(function).body
    assert isinstance(node, ast.FunctionDef)
    first = node.body[0]
    skipped_lines = first.end_lineno if ast.get_docstring(node) else first.lineno - 1
    return "\n".join(function.splitlines()[skipped_lines:])
