"""The course's plan: homeworks, tasks, points and dates, read from plan.toml, and what each student draws.

An instructor changes plan.toml, or gives the path of another. A task is a function of hdrlab: the
solution is that function, the handout its signature, and the checks are in
course/checks/specification/test_<id>.py. Or it is a function of the instructor's own,
"vignette.py:vignette", in a file beside the plan; its checks are test_<id>.py in the same folder,
and its mistakes in `mistakes`.
"""

import hmac
import math
import os
import runpy
import secrets
import tomllib
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from datetime import datetime
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

from hdrlab.course.variants import rewording
from hdrlab.errors import FileFormatError, InputError

PLAN = Path(__file__).with_name("plan.toml")
ANSWER_TIMEOUT_SECONDS = 10.0


class Task(NamedTuple):
    """One function to write: what it is called in the checks, where the library has it, and its points.

    A function that is not the library's is written as the path of its file, a colon, and its name.
    `minimum` marks what everybody is to write, also those who write little. `parameters` are those
    in which students' sheets differ, and `variant` is what one of them asks; see
    `variants.rewording`.
    """

    id: str
    function: str
    points: float
    minimum: bool = False
    parameters: tuple[str, ...] = ()
    variant: str = ""

    @property
    def name(self) -> str:
        """The function's own name."""
        return self.function.replace(":", ".").rpartition(".")[2]

    @property
    def own(self) -> Path | None:
        """The file of a function that is not the library's, or None."""
        file = self.function.rpartition(":")[0]
        return Path(file) if file else None


class ManualTask(NamedTuple):
    """What a person judges, and a line for each number of points that says what earns them."""

    title: str
    points: float
    rubric: tuple[str, ...] = ()


class Homework(NamedTuple):
    """A sheet of tasks, when it is due, and how many points count at most where its tasks give more."""

    name: str
    title: str
    due: datetime
    tasks: tuple[Task, ...]
    by_hand: tuple[ManualTask, ...] = ()
    at_most: float | None = None

    @property
    def points(self) -> float:
        """What the checks can give."""
        whole = sum(task.points for task in self.tasks)
        return whole if self.at_most is None else min(whole, self.at_most)


class Late(NamedTuple):
    """What being late costs: nothing for so many days of the whole course, and then points a day."""

    free_days: int = 0
    points_a_day: float = 0.0


class Plan(NamedTuple):
    """The course's homeworks by name, and its rule for what comes late."""

    homeworks: dict[str, Homework]
    late: Late = Late()

    def task(self, id: str) -> Task:
        """Return the task of that id, or raise a KeyError that lists those there are."""
        tasks = {task.id: task for homework in self.homeworks.values() for task in homework.tasks}
        if id not in tasks:
            raise KeyError(f"expected a task out of {', '.join(tasks)}, got {id!r}")
        return tasks[id]


@dataclass(frozen=True)
class GradingOptions:
    """How a submission is graded.

    Attributes
    ----------
    tier : "strict", "container" or "practice"
    student, secret : what the inputs are drawn from; without a student they are the public ones
    hidden : folder with the instructor's own checks, test_<task>.py
    timeout : seconds for one answer
    draw : whether pictures of differences are drawn
    """

    tier: str = "strict"
    student: str = ""
    secret: str = ""
    hidden: Path | None = None
    timeout: float = ANSWER_TIMEOUT_SECONDS
    draw: bool = True


def read(path: str | Path | None = None) -> Plan:
    """Return the Plan that stands in the file at `path`; None is the one that comes with hdrlab.

    Raises
    ------
    ValueError
        For a file that is no plan: which homework and what is wrong with it.

    Examples
    --------
    >>> plan = read()
    >>> plan.task("gsolve").function
    'response.debevec.gsolve'
    >>> plan.homeworks["hw2"].points
    100.0
    """
    path = PLAN if path is None else Path(path)
    try:
        sheets = tomllib.loads(path.read_text(encoding="utf8"))
    except (
        ValueError,
        RecursionError,
    ) as error:  # of digits beyond counting, and brackets in brackets
        raise InputError(f"{path}: expected a plan in TOML, {error}") from None
    late = _late(sheets.pop("late", {}), path)
    plan = Plan({name: _homework(name, sheet, path) for name, sheet in sheets.items()}, late)
    ids = [task.id for homework in plan.homeworks.values() for task in homework.tasks]
    twice = sorted({id for id in ids if ids.count(id) > 1})
    if not ids or twice:
        raise InputError(
            f"{path}: expected tasks, each once, got {', '.join(twice) or 'none':.200}"
        )
    return plan


def _late(table: dict[str, Any], path: Path) -> Late:
    with suppress(TypeError):
        late = Late(**table)
        if late.free_days >= 0 and late.points_a_day >= 0:
            return late
    raise InputError(
        f"{path}: expected free_days and points_a_day, at least 0, in [late], got {table!s:.80}"
    )


def _homework(name: str, sheet: dict[str, Any], path: Path) -> Homework:
    here = f"[{name:.80}]"
    try:
        tasks = tuple(_task(one, path) for one in sheet["tasks"])
        by_hand = tuple(
            ManualTask(one["title"], float(one["points"]), tuple(map(str, one.get("rubric", ()))))
            for one in sheet.get("by_hand", ())
        )
        at_most = float(sheet["at_most"]) if "at_most" in sheet else None
        made = Homework(name, sheet["title"], sheet["due"], tasks, by_hand, at_most)
    except (KeyError, TypeError, ValueError, OverflowError) as error:
        raise InputError(
            f"{path}: expected title, due and tasks in {here}, {error!r:.200}"
        ) from None
    if not isinstance(made.due, datetime) or made.due.tzinfo is None:
        raise InputError(
            f"{path}: expected due of {here} as a date with time and zone, got {made.due!s:.80}"
        )
    points = [one.points for one in tasks] + [one.points for one in by_hand]
    if not (points and min(points) >= 0 and sum(points) < math.inf):
        raise InputError(
            f"{path}: expected tasks or work by hand, of 0 points or more each, in {here}"
        )
    if at_most is not None and not 0 < at_most <= sum(points):
        most = sum(points)
        raise InputError(
            f"{path}: expected at_most of {here} above 0 and at most {most:g}, got {at_most:g}"
        )
    return made


def _task(one: dict[str, Any], plan: Path) -> Task:
    id, function, parameters = (
        one["id"],
        _placed(one["function"], plan),
        tuple(one.get("parameters", ())),
    )
    known = {} if ":" in function else rewording.parameters(id)
    if not {*parameters} <= {*known}:
        raise InputError(
            f"expected parameters of {id} out of {', '.join(known) or 'none'}, got {parameters}"
        )
    return Task(id, function, float(one["points"]), one.get("minimum") is True, parameters)


def _placed(function: str, plan: Path) -> str:
    """Return a function as a plan names it, the file of one that is not the library's with its folder."""
    file, colon, name = function.rpartition(":")
    if colon and not (file.endswith(".py") and file == Path(file).name and name):
        raise InputError(
            f"expected a function of hdrlab, or FILE.py:NAME beside the plan, got {function}"
        )
    return f"{plan.resolve().parent / file}:{name}" if colon else function


def function(task: Task) -> Callable[..., Any]:
    """Return the function that solves a task: the library's, a variant of it, or the instructor's."""
    if task.variant:
        return rewording.function(task.id, task.function, task.variant)
    if task.own is not None:
        return runpy.run_path(str(task.own))[task.name]
    module, _, name = task.function.rpartition(".")
    return getattr(import_module(f"hdrlab.{module}"), name)


def read_secret(path: Path) -> tuple[str, bool]:
    """Return the course's secret, and whether it was made just now: it is where the file is missing.

    Raises
    ------
    ValueError
        For an empty file.
    """
    made = not path.exists()
    if made:
        with open(
            os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w", encoding="utf8"
        ) as file:
            file.write(secrets.token_urlsafe(32) + "\n")
    try:
        secret = path.read_text(encoding="utf8").strip()
    except UnicodeDecodeError:
        raise FileFormatError(f"{path}: the secret file is not a text file in UTF-8") from None
    if not secret:
        raise InputError(f"{path}: expected a line that nobody else knows, it is empty")
    return secret, made


def seed(secret: str, student: str, task: str) -> int:
    """Return what a student's inputs to a task are drawn from: HMAC(course secret, student, task).

    Nobody without the secret can tell another's inputs, and the same three give the same inputs
    again.

    Examples
    --------
    >>> seed("salt", "ada", "gsolve") == seed("salt", "ada", "gsolve") != seed("salt", "ada", "merge")
    True
    """
    drawn = hmac.digest(secret.encode(), f"{student}\0{task}".encode(), "sha256")
    return int.from_bytes(drawn, "big")


def draw_variants(
    homework: Homework, student: str, secret: str, on_sheet: Mapping[str, str] | None = None
) -> Homework:
    """Return a homework with the variants of its tasks that a student is asked.

    Parameters
    ----------
    homework : the homework, with the parameters that the plan lets vary
    student, secret : with both, the course's secret draws the variants
    on_sheet : without them, the variants by task that the student's sheet names are used, as when a
        student checks her own work

    Examples
    --------
    >>> homework = read().homeworks["hw1"]
    >>> draw_variants(homework, "", "") == homework
    True
    """
    tasks = []
    for task in homework.tasks:
        if student and secret:
            variant = _drawn_variant(task, student, secret)
        else:
            variant = (on_sheet or {}).get(task.id, "")
            if variant not in rewording.every(task.id):
                variant = ""
        tasks.append(task._replace(variant=variant))
    return homework._replace(tasks=tuple(tasks))


def _drawn_variant(task: Task, student: str, secret: str) -> str:
    """Return the variant of a task that the course's secret draws for a student."""
    if not task.parameters:
        return ""
    values = []
    for parameter, choices in rewording.parameters(task.id).items():
        number = 0
        if parameter in task.parameters:
            number = seed(secret, student, f"{task.id} {parameter}") % len(choices)
        values.append(list(choices)[number])
    return "/".join(values)


def tasks_of_other_variants(homework: Homework, on_sheet: Mapping[str, str] | None) -> list[str]:
    """Return the tasks for which a sheet names another variant than the homework asks.

    A file without a sheet (`on_sheet` is None) names none.
    """
    if on_sheet is None:
        return []
    return [task.id for task in homework.tasks if on_sheet.get(task.id, "") != task.variant]
