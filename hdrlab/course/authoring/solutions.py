"""Handouts filled in, rightly or with a well-known mistake; the pack of solutions; a sheet for each team.

What is right is the library's own function, that of the library that is installed, and a mistake
changes it. The pack also gets the answers to the exercises, which are in a clone alone. Neither the
wheel nor the source distribution holds the pack.
"""

import json
from collections.abc import Iterable, Iterator, Mapping
from itertools import product
from pathlib import Path
from typing import Any

from hdrlab.course import materials
from hdrlab.course.authoring import handouts
from hdrlab.course.checks import misconceptions
from hdrlab.course.plan import Homework, Plan, draw_variants
from hdrlab.errors import InputError

FENCE = "\n\n\n# %%\n"
HEAD = Path(__file__).with_name("solutions_head.md")  # of the table of what is in the pack
EXERCISES_FOLDER = "exercises"
WRITTEN_SHEET = "written_questions.md"
WRITTEN_NOTE = f"""
The notebook of written questions has model answers, marking schemes and simulations.
`{WRITTEN_SHEET}` is the sheet for students: the questions alone, and the only file here to hand out.
"""
# of a cell that students do not get
INSTRUCTOR_TAG = "instructor"
EXERCISES_NOTE = f"""
The folder `{EXERCISES_FOLDER}` has the answers to the exercises at the end of each notebook.
"""


def texts(homework: Homework, mistakes: Iterable[str] = ()) -> dict[str, str]:
    """Return the text of the cell of each task.

    Parameters
    ----------
    homework : the homework whose tasks are solved
    mistakes : names of known mistakes, at most one for each task; all other tasks are right

    Examples
    --------
    >>> from hdrlab.course import plan
    >>> cells = texts(plan.read().homeworks["hw2"], ["gsolve_lambda_read_as_1"])
    >>> "smoothness * w[z]" in cells["gsolve"], "hdrlab" in "".join(cells.values())
    (False, False)
    """
    return dict(misconceptions.solutions(homework.tasks, mistakes))


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


def written_sheet(questions: str) -> str:
    """Return the sheet for students, in Markdown, of a notebook with questions and model answers."""
    cells = json.loads(questions)["cells"]
    shown = [
        "".join(cell["source"])
        for cell in cells
        if INSTRUCTOR_TAG not in cell["metadata"].get("tags", ())
    ]
    return "\n\n".join(shown) + "\n"


def write(
    plan: Plan, folder: Path, answers: Iterable[Path] = (), written: Path | None = None
) -> Iterator[Path]:
    """Write the pack into a folder, which is made where it is missing, and yield each file.

    Parameters
    ----------
    plan : the homeworks
    folder : where the pack goes
    answers : notebooks with answers to the exercises of the lessons, copied as they are
    written : the notebook of written questions, copied as it is; students get its sheet
    """
    table = HEAD.read_text("utf8")
    for name, homework in plan.homeworks.items():
        cells = texts(homework)
        yield handouts.write_text(folder / f"{name}.py", script(cells))
        if not any(task.own for task in homework.tasks):  # whose sheet stands elsewhere
            yield handouts.write_text(folder / f"{name}.ipynb", notebook(homework, cells))
        for task in homework.tasks:
            lines = len(cells[task.id].splitlines())
            table += f"| {name} | `{task.id}` | {task.points:g} | {lines} | `{task.function}` |\n"
    copies = []
    for answer in answers:
        copy = folder / EXERCISES_FOLDER / answer.name
        copies.append(handouts.write_text(copy, answer.read_text(encoding="utf8")))
    yield from copies
    if copies:
        table += EXERCISES_NOTE
    if written is not None:
        questions = written.read_text(encoding="utf8")
        yield handouts.write_text(folder / written.name, questions)
        yield handouts.write_text(folder / WRITTEN_SHEET, written_sheet(questions))
        table += WRITTEN_NOTE
    yield handouts.write_text(folder / "README.md", table)


def build_for_teams_steps(
    plan: Plan,
    sources: Path,
    teams: Iterable[str],
    secret: str,
    assignments: Path,
    solutions: Path | None,
) -> Iterator[Path]:
    """Write the homeworks of which parameters vary for each team, in folders of their names; yield each file.

    Parameters
    ----------
    plan, sources, assignments, solutions : as `handouts.build_steps` takes them; solutions are not
        run
    teams : who work together, and get one sheet
    secret : the course's, which draws the variants

    Raises
    ------
    ValueError
        Where no task of the plan has parameters, and for a source that does not ask what a variant
        rewords.
    """
    varied = [one for one in plan.homeworks.values() if any(task.parameters for task in one.tasks)]
    if not varied:
        raise InputError(
            "expected a plan that gives parameters to a task, got one that asks all the same"
        )
    for team, homework in product(teams, varied):
        made = handouts.made_of(plan, draw_variants(homework, team, secret), sources)
        for folder, sheet in ((assignments, made.assignment), (solutions, made.solution)):
            if folder is not None:
                file = folder / team / f"{homework.name}.ipynb"
                yield handouts.write_text(file, handouts.to_text(sheet))
