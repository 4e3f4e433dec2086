"""Handouts out of one source: the prose stands in solutions/*.py, the functions stand in the library.

A source is a Python file in the percent form. Its cells say by their metadata what they are:

task="gsolve"   becomes the function's signature and docstring over a stub, or, in the solution, the library's
                own source; comment lines in the cell take the place of the docstring's beginning.
                What the function yields or returns by name is given before it, and
                `check("gsolve")` follows.
about="gsolve hat"  is left out where the plan leaves one of these tasks out; a picture shows what they do
{points}, {due}, {total}, {choice}, {late}, {hand}   in the prose stand for what the plan says
use_plan("hw2")   gets the points of each task, so that `check` knows them wherever the sheet goes
"""

import json
import tempfile
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from hdrlab.course.authoring import stubs
from hdrlab.course.plan import Homework, ManualTask, Plan, Task
from hdrlab.course.source_code import inline
from hdrlab.course.variants import rewording
from hdrlab.errors import InputError
from hdrlab.io.files import write

KERNEL = {
    "kernelspec": {"display_name": "Python 3 (ipykernel)", "language": "python", "name": "python3"},
    "language_info": {"name": "python"},
}


# folder beside the sheet, for the checks of tasks that are not hdrlab's
CHECKS = "{}-checks"


class Handout(NamedTuple):
    """A homework's two notebooks, as JSON holds them: to be filled in, and filled in."""

    homework: str
    assignment: dict[str, Any]
    solution: dict[str, Any]


def handout(source: str, homework: Homework, late: str = "") -> Handout:
    """Return both notebooks of a homework.

    Parameters
    ----------
    source : text of its file in solutions/
    homework : what the plan says of it
    late : what being late costs, in words
    """
    import jupytext

    read = jupytext.reads(source, fmt="py:percent").cells
    tasks = {task.id: task for task in homework.tasks}
    given = [dotted for task in homework.tasks for dotted in stubs.classes(task.function)]
    blocks = inline.inlined({task.id: task.function for task in homework.tasks}, given)
    both: tuple[list[dict[str, Any]], list[dict[str, Any]]] = ([], [])
    for one in homework.tasks:
        prose = (
            cell.source for cell in read if cell.cell_type == "markdown" and one.id in _about(cell)
        )
        rewording.reword(one.id, one.variant, "\n".join(prose), all_of_it=True)
    for cell in read:
        about = _about(cell)
        if not set(about) <= set(tasks):
            continue
        for one in (tasks[id] for id in about if "task" not in cell.metadata):
            cell.source = rewording.reword(one.id, one.variant, cell.source)
        task = tasks[about[0]] if about else None
        if cell.cell_type == "markdown":
            text = _filled(cell.source, homework, task, late)
            made = [(_markdown(text), _markdown(text))]
        elif "task" in cell.metadata and task is not None:
            made = list(_task_cells(task, cell.source, blocks))
        elif about:  # a picture of what the task does: nothing to see before it is written
            made = [(_code(cell.source, tags=["raises-exception"]), _code(cell.source))]
        else:
            made = [(_code(_planned(cell.source, homework), given=True),) * 2]
        for notebook, column in zip(both, zip(*made, strict=True), strict=True):
            notebook += column
    return Handout(homework.name, *(_notebook(cells, homework.name) for cells in both))


def _about(cell: Any) -> list[str]:
    """Return the tasks that a cell of a source is about."""
    return (cell.metadata.get("about") or cell.metadata.get("task") or "").split()


def _task_cells(
    task: Task, opening: str, blocks: Mapping[str, inline.Block]
) -> Iterator[tuple[dict[str, Any], dict[str, Any]]]:
    """Yield the cells of a task, each for the assignment and for the solution."""
    for dotted in stubs.classes(task.function):
        yield (_code(stubs.bare_class(dotted), given=True),) * 2
    said = "\n".join(line.removeprefix("#").removeprefix(" ") for line in opening.splitlines())
    both = (stubs.stub(task, said.strip()), blocks[task.id].text)
    stub, solved = (rewording.reword(task.id, task.variant, text) for text in both)
    name = f"task-{task.id}"
    yield _code(stub, task=task.id, id=name), _code(solved, task=task.id, id=name)
    yield (_code(f'check("{task.id}")', id=f"check-{task.id}"),) * 2


def _planned(text: str, homework: Homework) -> str:
    """Return a cell in which `use_plan` says what each task is worth."""
    points = ", ".join(f"{task.id}={task.points:g}" for task in homework.tasks)
    if homework.at_most is not None:
        points = f"at_most={homework.at_most:g}, {points}"
    if asked := {task.id: task.variant for task in homework.tasks if task.variant}:
        points = f"{points}, variants={json.dumps(asked)}"
    if any(task.own for task in homework.tasks):
        points = f'plan="{CHECKS.format(homework.name)}/plan.toml", {points}'
    said = textwrap.fill(
        f'use_plan("{homework.name}", {points})',
        96,
        subsequent_indent=9 * " ",
        break_on_hyphens=False,
    )
    return text.replace(f'use_plan("{homework.name}")', said)


def _filled(text: str, homework: Homework, task: Task | None, late: str) -> str:
    """Return prose with what the plan says in place of its names in braces."""
    tasks = sum(one.points for one in homework.tasks)
    said = {
        "points": _points_text(task),
        "total": f"{homework.points + sum(one.points for one in homework.by_hand):g}",
        "choice": f"Choose: the tasks give {tasks:g} points, of which {homework.points:g} count at most.",
        "due": f"{homework.due:%A, %d %B %Y, %H:%M} {homework.due.tzname()}",
        "late": late,
        "hand": "\n".join(_judged(one) for one in homework.by_hand),
    }
    for name, value in said.items():
        text = text.replace(f"{{{name}}}", value)
    return text


def _points_text(task: Task | None) -> str:
    """Return the points of a task, and whether everybody must write it."""
    if task is None:
        return ""
    required = ", required" if task.minimum else ""
    return f"{task.points:g} points{required}"


def _judged(one: ManualTask) -> str:
    """Return what a person judges as an item of a list, and what earns how many points below it."""
    return "\n  - ".join([f"- **{one.title}** ({one.points:g} points)", *one.rubric])


def lateness(plan: Plan) -> str:
    """Return what late days cost, as a sentence for the assignment."""
    free_days = plan.late.free_days
    cost = plan.late.points_a_day
    points = "1 point" if cost == 1 else f"{cost:g} points"
    if free_days == 0:
        return f"Each late day costs {points}."
    days = "1 late day" if free_days == 1 else f"{free_days:g} late days"
    return f"You have {days} for the whole course; each extra day costs {points}."


def _markdown(text: str) -> dict[str, Any]:
    return {"cell_type": "markdown", "metadata": {}, "source": text}


def _code(text: str, *, id: str = "", tags: Sequence[str] = (), **marks: Any) -> dict[str, Any]:
    metadata = {**({"hdrlab": marks} if marks else {}), **({"tags": list(tags)} if tags else {})}
    cell: dict[str, Any] = {
        "cell_type": "code",
        "execution_count": None,
        "outputs": [],
        "metadata": metadata,
    }
    return {**cell, "source": text, **({"id": id} if id else {})}


def _notebook(cells: Sequence[dict[str, Any]], name: str) -> dict[str, Any]:
    named = [{"id": f"{name}-{n:02d}", **cell} for n, cell in enumerate(cells, 1)]
    return {"cells": named, "metadata": KERNEL, "nbformat": 4, "nbformat_minor": 5}


def to_text(notebook: dict[str, Any]) -> str:
    """Return a notebook as its file holds it: source in lines, so that a difference can be read."""
    split = [
        {**cell, "source": cell["source"].splitlines(keepends=True)} for cell in notebook["cells"]
    ]
    return (
        json.dumps({**notebook, "cells": split}, indent=1, ensure_ascii=False, sort_keys=True)
        + "\n"
    )


def build_steps(
    plan: Plan, sources: Path, assignments: Path, solutions: Path | None, *, jobs: int = 2
) -> Iterator[Path]:
    """Write the notebooks of all homeworks, and yield each file when it is there.

    Parameters
    ----------
    plan : what is in each homework
    sources : folder with the prose, a file <homework>.py for each
    assignments, solutions : folders for the notebooks; without the second none is run
    jobs : how many solutions run at a time

    Raises
    ------
    ValueError
        For a homework without a source, or a task the library does not have.
    """
    made = [made_of(plan, homework, sources) for homework in plan.homeworks.values()]
    for one in made:
        yield write_text(assignments / f"{one.homework}.ipynb", to_text(one.assignment))
        yield from _own_checks(plan.homeworks[one.homework], assignments)
    if solutions is not None:
        yield from _solved(made, assignments, solutions, jobs)


def made_of(plan: Plan, homework: Homework, sources: Path) -> Handout:
    """Return a homework's handout out of its source in a folder, or raise a ValueError."""
    source = sources / f"{homework.name}.py"
    if not source.is_file():
        where = "it is in a clone of hdrlab, in solutions/"
        raise InputError(f"expected the prose of {homework.name} in {source}; {where}")
    return handout(source.read_text(encoding="utf8"), homework, lateness(plan))


def _own_checks(homework: Homework, folder: Path) -> Iterator[Path]:
    """Copy the plan and the checks of tasks that are not hdrlab's, no solution, and yield each file."""
    own = [(task.own.parent, f"test_{task.id}.py") for task in homework.tasks if task.own]
    for file in dict.fromkeys(home / name for home, check in own for name in ("plan.toml", check)):
        copy = folder / CHECKS.format(homework.name) / file.name
        yield write_text(copy, file.read_text(encoding="utf8"))


def _solved(
    made: Sequence[Handout], assignments: Path, solutions: Path, jobs: int
) -> Iterator[Path]:
    """Run the solutions, and yield each file when it is written."""
    near = {one.homework: f"{CHECKS.format(one.homework)}/plan.toml" for one in made}
    far = {
        name: (assignments / plan).resolve().as_posix() for name, plan in near.items()
    }  # run elsewhere
    from hdrlab.course.authoring import execute

    texts = {one.homework: to_text(one.solution) for one in made}
    texts = {name: text.replace(near[name], far[name]) for name, text in texts.items()}
    with tempfile.TemporaryDirectory(
        prefix="hdrlab-solutions-", ignore_cleanup_errors=True
    ) as folder:
        scratch = Path(folder)
        sources = [write_text(scratch / f"{name}.ipynb", text) for name, text in texts.items()]
        for done in execute.run_steps(sources, scratch / "run", jobs=jobs):
            ran, name = json.loads(done.executed.read_text(encoding="utf8")), done.source.stem
            yield write_text(
                solutions / done.source.name, to_text(_tidy(ran)).replace(far[name], near[name])
            )


def _tidy(ran: dict[str, Any]) -> dict[str, Any]:
    """Return a notebook that was run without when it was, and by what."""
    cells = []
    for cell in ran["cells"]:
        metadata = {name: value for name, value in cell["metadata"].items() if name != "execution"}
        cells.append({**cell, "metadata": metadata, "source": "".join(cell["source"])})
    return {**ran, "cells": cells, "metadata": KERNEL}


def write_text(file: Path, text: str) -> Path:
    """Write a file of the course, whole or not at all, and return it."""
    file.parent.mkdir(parents=True, exist_ok=True)
    return write(file, text)
