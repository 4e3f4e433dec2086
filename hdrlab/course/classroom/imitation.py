"""What students hand in, imitated: the handout filled in, rightly or with a well-known mistake.

What is right is the library's own function. A mistake changes it, or is a file of `checks/mistakes`; where
that calls the library, which no submission can import, a copy of the function stands beside it, under a name
of its own.
"""

import ast
import json
import re
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from hdrlab.course.checks import MISTAKES
from hdrlab.course.checks.misconceptions import CHANGES, put_in, task_of
from hdrlab.course.code import inline, names, source
from hdrlab.course.material import handouts, materials
from hdrlab.course.plan import Homework

FENCE = "\n\n\n# %%\n"


class Mistake(NamedTuple):
    """A wrong file: its task, its text, and what it calls of the library, as written there and dotted."""

    task: str
    text: str
    calls: dict[str, str]


def texts(homework: Homework, mistakes: Iterable[str] = ()) -> dict[str, str]:
    """Return what stands in the cell of each task.

    Parameters
    ----------
    homework : whose tasks
    mistakes : names of mistakes, at most one for each task; the other tasks are right

    Examples
    --------
    >>> from hdrlab.course import plan
    >>> cells = texts(plan.read().homeworks["hw2"], ["recover_one_curve_for_all"])
    >>> "recover_of_mitsunaga(gray, times" in cells["recover"], "hdrlab" in "".join(cells.values())
    (True, False)
    """
    mistakes = list(mistakes)
    wrong = {one.task: one for one in (mistake(name) for name in mistakes if name not in CHANGES)}
    called = {task.function: task.id for task in homework.tasks if task.id not in wrong}
    owners = dict(called)  # which cell a function stands in
    for one in wrong.values():
        for function in one.calls.values():
            called.setdefault(function, _apart(function))
            owners.setdefault(function, one.task)
    blocks = inline.inlined({name: function for function, name in called.items()})
    cells: dict[str, list[str]] = {task.id: [] for task in homework.tasks}
    for function, name in called.items():
        cells[owners[function]].append(blocks[name].text)
    for one in wrong.values():
        cells[one.task].append(_calling(one, called))
    filled = {task: "\n\n\n".join(parts) for task, parts in cells.items()}
    for name in (name for name in mistakes if name in CHANGES):
        filled = put_in(filled, name)
    return filled


def mistake(name: str) -> Mistake:
    """Return a wrong file, read and not run."""
    file = next(MISTAKES.rglob(f"{name}.py"))
    text = file.read_text(encoding="utf8")
    body = ast.parse(text).body[1:]
    house: dict[str, str] = {}
    kept = []
    for node in body:
        if isinstance(node, ast.ImportFrom) and str(node.module).startswith(source.HOUSE):
            house |= {one.asname or one.name: f"{node.module}.{one.name}" for one in node.names}
        else:
            kept.append(node)
    calls = {}
    for use in (use for node in kept for use in names.free(node) if use.node.id in house):
        home, _, name = house[use.node.id].rpartition(".")
        if name in source.module(home).definitions:
            calls[use.node.id] = _home(home, name)
        else:
            calls[ast.unparse(use.whole)] = _home(house[use.node.id], use.attribute)
    return Mistake(
        task_of(file.stem), "\n\n\n".join(str(ast.get_source_segment(text, node)) for node in kept), calls
    )


def _home(module: str, name: str) -> str:
    """Return where the library defines what a module has under a name, dotted under hdrlab."""
    while name in source.module(module).imported:
        module, name, _ = source.module(module).imported[name]
    return f"{module}.{name}".partition(".")[2]


def _apart(function: str) -> str:
    """Return the name of a copy: gsolve_of_debevec."""
    home, _, name = function.rpartition(".")
    return f"{name}_of_{home.rpartition('.')[2]}"


def _calling(one: Mistake, called: Mapping[str, str]) -> str:
    """Return the text of a mistake, which calls copies in place of the library."""
    text = one.text
    for written, function in one.calls.items():
        text = re.sub(rf"\b{re.escape(written)}\b", called[function], text)
    return text


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
