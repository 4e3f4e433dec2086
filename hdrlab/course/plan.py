"""The course's plan: homeworks, tasks, points and dates, read from plan.toml, and what each student draws.

An instructor changes plan.toml, or gives the path of another. A homework is due in a week of the
course, and if the plan has a `first_day`, on a date.

A task is a function of hdrlab: the solution is that function, the handout its signature, and the
checks are in course/checks/specification/test_<id>.py. Or it is a function of the instructor's own,
"vignette.py:vignette", in a file beside the plan; its checks are test_<id>.py in the same folder,
and its mistakes in `mistakes`.
"""

import hmac
import math
import runpy
import secrets
import tomllib
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from datetime import date
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

from hdrlab.course import due_dates
from hdrlab.course.due_dates import Due
from hdrlab.course.limits import CALL_TIMEOUT_SECONDS
from hdrlab.course.variants import rewording
from hdrlab.errors import FileFormatError, InputError
from hdrlab.io.temporary import move_new, temporary_folder

PLAN = Path(__file__).with_name("plan.toml")
TEAM_SIZE = 2  # students in a team at most, unless the plan says otherwise


class Task(NamedTuple):
    """A function that students write.

    Attributes
    ----------
    id : its name in the assignment and in the checks
    function : where the library defines it; for an instructor's own, the path of the file, a colon
        and the function's name
    points : what it is worth
    minimum : whether it is required of every student
    parameters : names of the parameters that differ between students; see `variants.rewording`
    variant : the values of these parameters for one student, "" for the library's own
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
        """The file of an instructor's own function, or None."""
        file = self.function.rpartition(":")[0]
        return Path(file) if file else None


class ManualTask(NamedTuple):
    """A task that a person grades, with its rubric: a line for each number of points."""

    title: str
    points: float
    rubric: tuple[str, ...] = ()


class Homework(NamedTuple):
    """An assignment: its tasks, when it is due, and the points that count at most if its tasks give more."""

    name: str
    title: str
    due: Due
    tasks: tuple[Task, ...]
    by_hand: tuple[ManualTask, ...] = ()
    at_most: float | None = None

    @property
    def points(self) -> float:
        """Points that the checks can give."""
        possible = sum(task.points for task in self.tasks)
        return possible if self.at_most is None else min(possible, self.at_most)


class Late(NamedTuple):
    """The late-day rule: free days for the whole course, and the cost of each further day in points."""

    free_days: int = 0
    points_a_day: float = 0.0


class Plan(NamedTuple):
    """A course.

    Attributes
    ----------
    homeworks : by name
    late : the late-day rule
    team_size : students in a team at most
    first_day : the first day of the first week, or None; without it, homeworks may have a week of
        the course and no date
    holidays : any day of each week without a class
    """

    homeworks: dict[str, Homework]
    late: Late = Late()
    team_size: int = TEAM_SIZE
    first_day: date | None = None
    holidays: tuple[date, ...] = ()

    def task(self, id: str) -> Task:
        """Return the task with an id; raise a KeyError that lists all tasks if there is none."""
        tasks = {task.id: task for homework in self.homeworks.values() for task in homework.tasks}
        if id not in tasks:
            raise KeyError(f"expected a task out of {', '.join(tasks)}, got {id!r}")
        return tasks[id]


@dataclass(frozen=True)
class GradingOptions:
    """How a submission is graded.

    Attributes
    ----------
    tier : "strict", "container", "practice" or "in-process"
    student, secret : the inputs of the checks are drawn from both; without a student, they are the
        public inputs
    hidden : folder with the instructor's hidden checks, test_<task>.py
    timeout : seconds for one call of a student's function
    draw : whether differences are drawn as images
    """

    tier: str = "strict"
    student: str = ""
    secret: str = ""
    hidden: Path | None = None
    timeout: float = CALL_TIMEOUT_SECONDS
    draw: bool = True


def read(path: str | Path | None = None) -> Plan:
    """Read a plan. Without a path, read the plan that comes with hdrlab.

    Raises
    ------
    InputError
        For a file that is no plan; the message names the homework and what is wrong with it.

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
    # ValueError also for numbers with too many digits, RecursionError for brackets in brackets
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: expected a plan in TOML, {error}") from None
    late = _late(sheets.pop("late", {}), path)
    is_varied = sheets.pop("vary_all_tasks", False)
    if not isinstance(is_varied, bool):
        raise InputError(f"{path}: expected vary_all_tasks = true or false, got {is_varied!s:.80}")
    team_size = sheets.pop("team_size", TEAM_SIZE)
    if not isinstance(team_size, int) or team_size < 1:
        raise InputError(
            f"{path}: expected team_size as a number of students, got {team_size!s:.80}"
        )
    first_day = sheets.pop("first_day", None)
    holidays = sheets.pop("holidays", [])
    if not isinstance(holidays, list):
        raise InputError(f"{path}: expected holidays as a list of dates, got {holidays!s:.80}")
    for day in holidays if first_day is None else [first_day, *holidays]:
        if type(day) is not date:
            raise InputError(
                f"{path}: expected first_day and holidays as dates such as 2027-02-08, got {day!s:.80}"
            )
    homeworks = {}
    for name, sheet in sheets.items():
        homework = _homework(name, sheet, path, is_varied)
        due = due_dates.date_in_term(homework.due, first_day, holidays)
        homeworks[name] = homework._replace(due=due)
    plan = Plan(homeworks, late, team_size, first_day, tuple(holidays))
    ids = [task.id for homework in plan.homeworks.values() for task in homework.tasks]
    if not ids:
        raise InputError(f"{path}: expected tasks, got none")
    repeated = sorted({id for id in ids if ids.count(id) > 1})
    if repeated:
        raise InputError(f"{path}: expected each task once, got {', '.join(repeated):.200} twice")
    return plan


def _late(table: dict[str, Any], path: Path) -> Late:
    """Return the late-day rule of a plan."""
    with suppress(TypeError):
        late = Late(**table)
        if late.free_days >= 0 and late.points_a_day >= 0:
            return late
    raise InputError(
        f"{path}: expected free_days and points_a_day, at least 0, in [late], got {table!s:.80}"
    )


def _homework(name: str, sheet: dict[str, Any], path: Path, is_varied: bool) -> Homework:
    """Return a homework from its table in a plan; raise an InputError if something is wrong with it."""
    here = f"[{name:.80}]"
    try:
        homework = Homework(
            name=name,
            title=sheet["title"],
            due=due_dates.read(sheet["due"]),
            tasks=tuple(_task(table, path, is_varied) for table in sheet["tasks"]),
            by_hand=tuple(_manual_task(table) for table in sheet.get("by_hand", ())),
            at_most=float(sheet["at_most"]) if "at_most" in sheet else None,
        )
    except InputError as error:
        raise InputError(f"{path}: {here}: {error}") from None
    except (KeyError, TypeError, ValueError, OverflowError) as error:
        raise InputError(
            f"{path}: expected title, due and tasks in {here}, {error!r:.200}"
        ) from None
    points = [task.points for task in homework.tasks]
    points += [manual.points for manual in homework.by_hand]
    if not (points and min(points) >= 0 and sum(points) < math.inf):
        raise InputError(
            f"{path}: expected tasks or work by hand, of 0 points or more each, in {here}"
        )
    at_most = homework.at_most
    possible = sum(points)
    if at_most is not None and not 0 < at_most <= possible:
        raise InputError(
            f"{path}: expected at_most of {here} above 0 and at most {possible:g}, got {at_most:g}"
        )
    return homework


def _manual_task(table: dict[str, Any]) -> ManualTask:
    """Return a task that a person grades, from its table in a plan."""
    rubric = tuple(str(line) for line in table.get("rubric", ()))
    return ManualTask(title=table["title"], points=float(table["points"]), rubric=rubric)


def _task(table: dict[str, Any], plan: Path, is_varied: bool) -> Task:
    """Return a task from its table in a plan; `is_varied` gives it all its parameters by default."""
    id = table["id"]
    function = _with_folder(table["function"], plan)
    known = {} if ":" in function else rewording.parameters(id)
    parameters = tuple(table.get("parameters", known if is_varied else ()))
    if not set(parameters) <= set(known):
        raise InputError(
            f"expected parameters of {id} out of {', '.join(known) or 'none'}, got {parameters}"
        )
    return Task(
        id=id,
        function=function,
        points=float(table["points"]),
        minimum=table.get("minimum") is True,
        parameters=parameters,
    )


def _with_folder(function: str, plan: Path) -> str:
    """Return the name of a function in a plan, with the plan's folder for an instructor's own file."""
    file, colon, name = function.rpartition(":")
    if not colon:
        return function
    if not (file.endswith(".py") and file == Path(file).name and name):
        raise InputError(
            f"expected a function of hdrlab, or FILE.py:NAME beside the plan, got {function}"
        )
    return f"{plan.resolve().parent / file}:{name}"


def function(task: Task) -> Callable[..., Any]:
    """Return the function that solves a task: the library's, a variant of it, or an instructor's own."""
    if task.variant:
        return rewording.function(task.id, task.function, task.variant)
    if task.own is not None:
        return runpy.run_path(str(task.own))[task.name]
    module, _, name = task.function.rpartition(".")
    return getattr(import_module(f"hdrlab.{module}"), name)


def read_secret(path: Path) -> tuple[str, bool]:
    """Return the course's secret, and whether this call created it because the file did not exist.

    Raises
    ------
    InputError
        For an empty file, and one that is not text.
    """
    is_new = not path.exists()
    if is_new:
        with temporary_folder(path.parent, target=path) as folder:
            unfinished = folder / "secret"
            unfinished.touch(mode=0o600)
            unfinished.write_text(secrets.token_urlsafe(32) + "\n", encoding="utf8")
            move_new(unfinished, path)
    try:
        secret = path.read_text(encoding="utf8").strip()
    except UnicodeDecodeError:
        raise FileFormatError(f"{path}: the secret file is not a text file in UTF-8") from None
    if not secret:
        raise InputError(
            f"{path}: the secret file is empty; write a line into it that nobody else knows"
        )
    return secret, is_new


def seed(secret: str, student: str, task: str) -> int:
    """Return the seed of a student's inputs to a task: HMAC(course secret, student, task).

    Nobody can compute it without the secret, and it is always the same for the same student and
    task.

    Examples
    --------
    >>> seed("salt", "ada", "gsolve") == seed("salt", "ada", "gsolve") != seed("salt", "ada", "merge")
    True
    """
    digest = hmac.digest(secret.encode(), f"{student}\0{task}".encode(), "sha256")
    return int.from_bytes(digest, "big")


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
