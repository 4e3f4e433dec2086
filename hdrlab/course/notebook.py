"""check("gsolve") in a notebook: what of the specification a function keeps that was just written.

The text of what was run is taken, with the helpers it needs, and called in a process of its own;
what is in the kernel stays as it is. It is the practice tier: it keeps mistakes apart, and its
points are no grade yet.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path

from hdrlab.course import plan as plans
from hdrlab.course.grading import grader, results
from hdrlab.course.reports import feedback
from hdrlab.course.source_code import closure, names
from hdrlab.course.submissions import reader
from hdrlab.errors import InputError

PRACTICE = plans.GradingOptions(tier="practice")
_latest: dict[str, results.Result] = {}  # of each task in this kernel, for the homework's bar
_plan: dict[
    str, plans.Homework
] = {}  # the homeworks whose sheets said in this kernel what is asked


class Feedback:
    """A Result as a notebook shows it; as text, what a terminal would show."""

    def __init__(self, result: results.Result, homework: plans.Homework) -> None:
        self.result, self.homework = result, homework

    @property
    def points(self) -> float:
        """Points earned by what was checked."""
        return self.result.score

    def __repr__(self) -> str:
        return feedback.text(self.result)

    def _repr_html_(self) -> str:
        whole = self.homework.points
        earned = sum(_latest[task.id].score for task in self.homework.tasks if task.id in _latest)
        below = feedback.bar(min(earned, whole), whole, f"{self.homework.name} so far")
        return f'<div class="hdrlab-check">{feedback.fragment(self.result)}{below}</div>'


def check(name: str, *, worth: float | None = None) -> Feedback:
    """Return what a task's function keeps of its promises, or all functions of a homework.

    Parameters
    ----------
    name : str
        A task, "gsolve", or a homework, "hw2".
    worth : float, optional
        Points of the task, where a course has a plan of its own.

    Raises
    ------
    ValueError
        For a name that is neither.
    RuntimeError
        Outside of a notebook; there, `hdrlab check FILE` does the same.
    """
    from IPython.display import HTML, DisplayHandle

    homework, tasks = find_tasks(name)
    sources, _ = closure.extract_sources(_history(), tasks, reader.given_cells(homework.name))
    absent = [task for task in tasks if task not in sources]
    missing = tuple(f"{task} is not there yet: run the cell that defines it" for task in absent)
    read = reader.SubmittedCode(
        sources, missing, "", tuple(names.imported_numpy_modules(sources.values()))
    )
    of_tasks = tuple(task for task in homework.tasks if task.id in tasks)
    if worth is not None:
        of_tasks = tuple(task._replace(points=worth) for task in of_tasks)
    steps, shown = (
        grader.check_steps(read, homework._replace(tasks=of_tasks), PRACTICE),
        DisplayHandle(),
    )
    shown.display(HTML(feedback.bar(0, 1, f"{name}, checking", "of its promises")))
    for done, result in enumerate(steps, 1):  # the last one always comes
        asked = len(result.checks)
        shown.update(HTML(feedback.bar(min(done, asked), asked, f"{name}, checking", "promises")))
    shown.update(HTML(""))
    for task in tasks:
        _latest[task] = result._replace(checks=result.of(task), problems=())
    return Feedback(result, homework)


def use_plan(
    name: str,
    at_most: float | None = None,
    *,
    plan: str | Path | None = None,
    variants: Mapping[str, str] | None = None,
    **points: float,
) -> None:
    """Take a homework's tasks and points from its sheet; without any, from hdrlab's own plan.

    Of the points, `at_most` so many count. Tasks that are not hdrlab's stand in the file `plan`,
    with their checks beside it. `variants` are those of the tasks of which not everybody is asked
    the same.
    """
    own = plans.read(plan)
    tasks = tuple(own.task(id)._replace(points=float(worth)) for id, worth in points.items())
    known = own.homeworks.get(name) or next(iter(own.homeworks.values()))._replace(
        name=name, title=name
    )
    asked = known._replace(tasks=tasks, at_most=at_most) if tasks else known
    _plan[name] = plans.draw_variants(asked, "", "", variants)


def find_tasks(name: str) -> tuple[plans.Homework, list[str]]:
    """Return the homework that a name belongs to, and the ids of the tasks it stands for."""
    homeworks = _plan | {
        key: one for key, one in plans.read().homeworks.items() if key not in _plan
    }
    if name in homeworks:
        return homeworks[name], [task.id for task in homeworks[name].tasks]
    for homework in homeworks.values():
        if name in [task.id for task in homework.tasks]:
            return homework, [name]
    tasks = ", ".join(task.id for homework in homeworks.values() for task in homework.tasks)
    raise InputError(
        f"expected a homework ({', '.join(homeworks)}) or a task ({tasks}), got {name!r}"
    )


def _history() -> Sequence[closure.Cell]:
    """Return what was run in this kernel, in order; what was no Python has told so already."""
    from IPython.core.getipython import get_ipython

    shell = get_ipython()
    if shell is None:
        raise RuntimeError("check works in a notebook; at a terminal, use: hdrlab check FILE")
    entered: list[str] = shell.history_manager.input_hist_raw  # type: ignore[union-attr]
    return [
        closure.Cell(text, where=f"input {n}") for n, text in enumerate(entered) if text.strip()
    ]
