"""Build assignments and worked solutions: prose from solutions/*.py, code from the library.

A source is a Python file in the percent format. The metadata of its cells say what they are:

task="gsolve"       In the assignment, the cell becomes a stub: the function's signature and
                    docstring. In the solution, it becomes the library's own source. Comment lines
                    in the cell replace the first paragraph of the docstring. Classes that the
                    function returns or yields come before it, and `check("gsolve")` after it.
about="gsolve hat"  The cell is left out if the plan does not have all of these tasks.
{points}, {due}, {total}, {choice}, {late}, {hand}   In the prose, these stand for what the plan says.
use_plan("hw2")     The call gets the points of each task, so that `check` knows them.
"""

import json
import tempfile
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from hdrlab.course import due_dates
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


# the folder beside an assignment with the checks of the instructor's own tasks
CHECKS_FOLDER = "{}-checks"
MAX_LINE_LENGTH = 96

Cell = dict[str, Any]


class Handout(NamedTuple):
    """The two notebooks of a homework, as JSON holds them."""

    homework: str
    assignment: dict[str, Any]
    solution: dict[str, Any]


class CellPair(NamedTuple):
    """A cell of the assignment and the same cell of the solution."""

    assignment: Cell
    solution: Cell


def handout(source: str, homework: Homework, late: str = "") -> Handout:
    """Return the assignment and the solution of a homework.

    Parameters
    ----------
    source : text of its file in solutions/
    homework : what the plan says about it
    late : the late-day rule as a sentence
    """
    import jupytext

    cells = jupytext.reads(source, fmt="py:percent").cells
    tasks = {task.id: task for task in homework.tasks}
    classes = [dotted for task in homework.tasks for dotted in stubs.classes(task.function)]
    blocks = inline.inlined({task.id: task.function for task in homework.tasks}, classes)
    for task in homework.tasks:
        _check_variant_applies(task, cells)
    pairs: list[CellPair] = []
    for cell in cells:
        task_ids = _task_ids(cell)
        if not set(task_ids) <= set(tasks):
            continue
        about = [tasks[task_id] for task_id in task_ids]
        pairs += _pairs_of_cell(cell, about, homework, late, blocks)
    return Handout(
        homework=homework.name,
        assignment=_notebook([pair.assignment for pair in pairs], homework.name),
        solution=_notebook([pair.solution for pair in pairs], homework.name),
    )


def _check_variant_applies(task: Task, cells: Sequence[Any]) -> None:
    """Raise an InputError if the prose about a task has none of the words that its variant changes."""
    prose = [
        cell.source for cell in cells if cell.cell_type == "markdown" and task.id in _task_ids(cell)
    ]
    rewording.reword(task.id, task.variant, "\n".join(prose), all_of_it=True)


def _pairs_of_cell(
    cell: Any,
    about: Sequence[Task],
    homework: Homework,
    late: str,
    blocks: Mapping[str, inline.Block],
) -> list[CellPair]:
    """Return the cells of both notebooks that one cell of the source becomes."""
    is_task = "task" in cell.metadata
    text = cell.source
    if not is_task:
        for task in about:
            text = rewording.reword(task.id, task.variant, text)
    if cell.cell_type == "markdown":
        filled = _fill_in(text, homework, about[0] if about else None, late)
        return [CellPair(_markdown(filled), _markdown(filled))]
    if is_task and about:
        return _task_cells(about[0], text, blocks)
    if about:  # a figure of what the task does: it fails until the task is written
        return [CellPair(_code(text, tags=["raises-exception"]), _code(text))]
    given = _code(_add_points(text, homework), given=True)
    return [CellPair(given, given)]


def _task_ids(cell: Any) -> list[str]:
    """Return the ids of the tasks that a cell of a source is about."""
    return (cell.metadata.get("about") or cell.metadata.get("task") or "").split()


def _task_cells(task: Task, opening: str, blocks: Mapping[str, inline.Block]) -> list[CellPair]:
    """Return the cells of a task: classes that it returns, the stub or the solution, and the check."""
    pairs = []
    for dotted in stubs.classes(task.function):
        text = rewording.reword(task.id, task.variant, stubs.bare_class(dotted))
        class_cell = _code(text, given=True)
        pairs.append(CellPair(class_cell, class_cell))
    docstring = "\n".join(line.removeprefix("#").removeprefix(" ") for line in opening.splitlines())
    stub = rewording.reword(task.id, task.variant, stubs.stub(task, docstring.strip()))
    solution = rewording.reword(task.id, task.variant, blocks[task.id].text)
    cell_id = f"task-{task.id}"
    pairs.append(
        CellPair(_code(stub, task=task.id, id=cell_id), _code(solution, task=task.id, id=cell_id))
    )
    check_cell = _code(f'check("{task.id}")', id=f"check-{task.id}")
    pairs.append(CellPair(check_cell, check_cell))
    return pairs


def _add_points(text: str, homework: Homework) -> str:
    """Return a cell whose call of `use_plan` says what each task is worth."""
    arguments = [f"{task.id}={task.points:g}" for task in homework.tasks]
    if homework.at_most is not None:
        arguments.insert(0, f"at_most={homework.at_most:g}")
    variants = {task.id: task.variant for task in homework.tasks if task.variant}
    if variants:
        arguments.append(f"variants={json.dumps(variants)}")
    if any(task.own for task in homework.tasks):
        arguments.insert(0, f'plan="{CHECKS_FOLDER.format(homework.name)}/plan.toml"')
    call = textwrap.fill(
        f'use_plan("{homework.name}", {", ".join(arguments)})',
        MAX_LINE_LENGTH,
        subsequent_indent=9 * " ",
        break_on_hyphens=False,
    )
    return text.replace(f'use_plan("{homework.name}")', call)


def _fill_in(text: str, homework: Homework, task: Task | None, late: str) -> str:
    """Return prose in which what the plan says replaces the names in braces."""
    points_of_tasks = sum(task.points for task in homework.tasks)
    points_by_hand = sum(manual.points for manual in homework.by_hand)
    replacements = {
        "points": _points_text(task),
        "total": f"{homework.points + points_by_hand:g}",
        "choice": (
            f"Choose: the tasks are worth {points_of_tasks:g} points in total, but at most "
            f"{homework.points:g} count."
        ),
        "due": due_dates.describe(homework.due),
        "late": late,
        "hand": "\n".join(_manual_task_text(manual) for manual in homework.by_hand),
    }
    for name, replacement in replacements.items():
        text = text.replace(f"{{{name}}}", replacement)
    return text


def _points_text(task: Task | None) -> str:
    """Return the points of a task, and whether everybody must write it."""
    if task is None:
        return ""
    required = ", required" if task.minimum else ""
    return f"{task.points:g} points{required}"


def _manual_task_text(manual: ManualTask) -> str:
    """Return a task that a person grades as an item of a list, with its rubric below."""
    lines = [f"- **{manual.title}** ({manual.points:g} points)", *manual.rubric]
    return "\n  - ".join(lines)


def lateness(plan: Plan) -> str:
    """Return what late days cost, as a sentence for the assignment."""
    free_days = plan.late.free_days
    cost = plan.late.points_a_day
    points = "1 point" if cost == 1 else f"{cost:g} points"
    if free_days == 0:
        return f"Each late day costs {points}."
    days = "1 late day" if free_days == 1 else f"{free_days:g} late days"
    return f"You have {days} for the whole course; each extra day costs {points}."


def _markdown(text: str) -> Cell:
    return {"cell_type": "markdown", "metadata": {}, "source": text}


def _code(text: str, *, id: str = "", tags: Sequence[str] = (), **marks: Any) -> Cell:
    """Return a code cell; `marks` (task, given) tell hdrlab what it is."""
    metadata: dict[str, Any] = {}
    if marks:
        metadata["hdrlab"] = marks
    if tags:
        metadata["tags"] = list(tags)
    cell: Cell = {
        "cell_type": "code",
        "execution_count": None,
        "outputs": [],
        "metadata": metadata,
        "source": text,
    }
    if id:
        cell["id"] = id
    return cell


def _notebook(cells: Sequence[Cell], name: str) -> dict[str, Any]:
    """Return a notebook; a cell without an id gets one from its place."""
    with_ids = [{"id": f"{name}-{number:02d}", **cell} for number, cell in enumerate(cells, 1)]
    return {"cells": with_ids, "metadata": KERNEL, "nbformat": 4, "nbformat_minor": 5}


def to_text(notebook: dict[str, Any]) -> str:
    """Return a notebook as its file holds it, with the source in lines so that a diff is readable."""
    cells = [
        {**cell, "source": cell["source"].splitlines(keepends=True)} for cell in notebook["cells"]
    ]
    with_lines = {**notebook, "cells": cells}
    return json.dumps(with_lines, indent=1, ensure_ascii=False, sort_keys=True) + "\n"


def build_steps(
    plan: Plan, sources: Path, assignments: Path, solutions: Path | None, *, jobs: int = 2
) -> Iterator[Path]:
    """Write the notebooks of all homeworks, and yield each file when it is written.

    Parameters
    ----------
    plan : the homeworks
    sources : folder with the prose, a file <homework>.py for each
    assignments, solutions : folders for the notebooks; None writes no solutions
    jobs : how many solutions run at a time

    Raises
    ------
    InputError
        For a homework without a source, or a task that the library does not have.
    """
    handouts = [made_of(plan, homework, sources) for homework in plan.homeworks.values()]
    for made in handouts:
        yield write_text(assignments / f"{made.homework}.ipynb", to_text(made.assignment))
        yield from _copy_own_checks(plan.homeworks[made.homework], assignments)
    if solutions is not None:
        yield from _run_solutions(handouts, assignments, solutions, jobs)


def made_of(plan: Plan, homework: Homework, sources: Path) -> Handout:
    """Return the handout of a homework, from its source in a folder.

    Raises
    ------
    InputError
        If the source is missing.
    """
    source = sources / f"{homework.name}.py"
    if not source.is_file():
        raise InputError(
            f"expected the prose of {homework.name} in {source}; it is in solutions/ of a clone of "
            "hdrlab's repository"
        )
    return handout(source.read_text(encoding="utf8"), homework, lateness(plan))


def _copy_own_checks(homework: Homework, folder: Path) -> Iterator[Path]:
    """Copy the plan and the checks of the instructor's own tasks, and yield each file; no solution."""
    sources: list[Path] = []
    for task in homework.tasks:
        if task.own:
            home = task.own.parent
            sources += [home / "plan.toml", home / f"test_{task.id}.py"]
    for path in dict.fromkeys(sources):
        copy = folder / CHECKS_FOLDER.format(homework.name) / path.name
        yield write_text(copy, path.read_text(encoding="utf8"))


def _run_solutions(
    handouts: Sequence[Handout], assignments: Path, solutions: Path, jobs: int
) -> Iterator[Path]:
    """Run the solutions, and yield each file when it is written.

    They run in another folder, so `use_plan` names the plan of an instructor's own task by its
    whole path meanwhile.
    """
    from hdrlab.course.authoring import execute

    relative = {
        made.homework: f"{CHECKS_FOLDER.format(made.homework)}/plan.toml" for made in handouts
    }
    absolute = {name: (assignments / plan).resolve().as_posix() for name, plan in relative.items()}
    with tempfile.TemporaryDirectory(
        prefix="hdrlab-solutions-", ignore_cleanup_errors=True
    ) as folder:
        scratch = Path(folder)
        sources = []
        for made in handouts:
            name = made.homework
            text = to_text(made.solution).replace(relative[name], absolute[name])
            sources.append(write_text(scratch / f"{name}.ipynb", text))
        for done in execute.run_steps(sources, scratch / "run", jobs=jobs):
            name = done.source.stem
            executed = json.loads(done.executed.read_text(encoding="utf8"))
            text = to_text(_without_times(executed)).replace(absolute[name], relative[name])
            yield write_text(solutions / done.source.name, text)


def _without_times(notebook: dict[str, Any]) -> dict[str, Any]:
    """Return an executed notebook without the times of execution and the kernel's version."""
    cells = []
    for cell in notebook["cells"]:
        metadata = {name: value for name, value in cell["metadata"].items() if name != "execution"}
        cells.append({**cell, "metadata": metadata, "source": "".join(cell["source"])})
    return {**notebook, "cells": cells, "metadata": KERNEL}


def write_text(file: Path, text: str) -> Path:
    """Write a file of the course, whole or not at all, and return it."""
    file.parent.mkdir(parents=True, exist_ok=True)
    return write(file, text)
