"""Check a student's functions in her notebook: `check("gsolve")`.

hdrlab takes the text of the cells that were run, extracts the function with the helpers that it
needs, and calls it in a process of its own. Nothing in the kernel changes. This is the practice
tier: it contains mistakes, not attacks, and its points are no grade yet. In a browser, where there
are no processes, the function runs in the kernel (the in-process tier).
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hdrlab.core.steps import last
from hdrlab.course import plan as plans
from hdrlab.course.grading import grader, results
from hdrlab.course.limits import CALL_TIMEOUT_SECONDS
from hdrlab.course.reports import feedback
from hdrlab.course.sandbox import in_process
from hdrlab.course.source_code import closure, names
from hdrlab.course.submissions import reader
from hdrlab.errors import InputError

if TYPE_CHECKING:
    from hdrlab.show.widgets.dialogue import Dialogue, Steps

# WebAssembly computes two to six times more slowly
BROWSER_TIMEOUT_FACTOR = 3.0
PRACTICE = plans.GradingOptions(tier="practice")
if in_process.IS_BROWSER:
    PRACTICE = plans.GradingOptions(
        tier=in_process.TIER, timeout=BROWSER_TIMEOUT_FACTOR * CALL_TIMEOUT_SECONDS
    )
# what messages call the code that `check_text` is given
TEXT_NAME = "Your text"
ABOUT_TUTOR = "The questions lead from a small input to the mistake. They cost no points."

# the latest result of each task in this kernel, for the bar of the homework
_latest: dict[str, results.Result] = {}
# the homeworks whose tasks and points `use_plan` has set in this kernel
_planned: dict[str, plans.Homework] = {}


class Feedback:
    """A Result, shown as HTML in a notebook and as plain text elsewhere."""

    # whether the reader must ask to see the likely mistakes
    folds_mistakes = False

    def __init__(self, result: results.Result, homework: plans.Homework) -> None:
        self.result = result
        self.homework = homework

    @property
    def points(self) -> float:
        """Points earned in the checked tasks."""
        return self.result.score

    def __repr__(self) -> str:
        return feedback.text(self.result)

    def _repr_html_(self) -> str:
        max_points = self.homework.points
        earned = sum(_latest[task.id].score for task in self.homework.tasks if task.id in _latest)
        label = f"{self.homework.name} so far"
        bar = feedback.bar(min(earned, max_points), max_points, label)
        fragment = feedback.fragment(self.result, fold_mistakes=self.folds_mistakes)
        return f'<div class="hdrlab-check">{fragment}{bar}</div>'


class FeedbackWithTutor(Feedback):
    """The Feedback of failed checks, with a button for each task about which the tutor can ask."""

    # the tutor's questions lead to them
    folds_mistakes = True

    def _ipython_display_(self) -> None:
        """Show the feedback, and below it the buttons. Without a kernel, show the feedback alone."""
        from IPython.display import display

        from hdrlab.course import tutor

        shown = {"text/html": self._repr_html_(), "text/plain": repr(self)}
        display(shown, raw=True)
        if hasattr(_shell(), "kernel"):
            for task_id in tutor.tasks_to_ask(self.result):
                display(self.dialogue(task_id))

    def dialogue(self, task_id: str) -> "Dialogue":
        """Return the button that asks three questions about a task of this result."""
        from hdrlab.course import tutor
        from hdrlab.show.widgets.dialogue import Dialogue

        task = next(task for task in self.homework.tasks if task.id == task_id)

        def start() -> "Steps":
            code = _code_of_kernel(self.homework, [task_id])
            if code.problems:
                raise InputError(" ".join(code.problems))
            yield from tutor.ask(task, code, self.result, PRACTICE)

        return Dialogue(f"Ask me three questions about {task_id}", start, about=ABOUT_TUTOR)


def check(name: str, *, worth: float | None = None) -> Feedback:
    """Run the checks of a task, or of all tasks of a homework, on the functions in this notebook.

    Parameters
    ----------
    name : str
        A task, such as "gsolve", or a homework, such as "hw2".
    worth : float, optional
        Points of the task, if a course has its own plan.

    Returns
    -------
    feedback : Feedback
        What is right, what is not, hints and points.

    Raises
    ------
    InputError
        For a name that is neither a task nor a homework.
    RuntimeError
        Outside a notebook; there, use `hdrlab check FILE`.
    """
    from IPython.display import HTML, DisplayHandle

    # a page of the site calls `check_text` and has no widgets
    from hdrlab.course import tutor

    homework, task_ids = find_tasks(name)
    code = _code_of_kernel(homework, task_ids)
    tasks = tuple(task for task in homework.tasks if task.id in task_ids)
    if worth is not None:
        tasks = tuple(task._replace(points=worth) for task in tasks)
    progress = DisplayHandle()
    progress.display(HTML(feedback.bar(0, 1, f"{name}, checking", "checks")))
    steps = grader.check_steps(code, homework._replace(tasks=tasks), PRACTICE)
    for number, result in enumerate(steps, 1):
        total = len(result.checks)
        done = min(number, total)
        progress.update(HTML(feedback.bar(done, total, f"{name}, checking", "checks")))
    progress.update(HTML(""))
    for task_id in task_ids:
        _latest[task_id] = replace(result, checks=result.of(task_id), problems=())
    if tutor.tasks_to_ask(result):
        return FeedbackWithTutor(result, homework)
    return Feedback(result, homework)


def check_text(name: str, text: str, *, draw: bool = True) -> results.Result:
    """Check one task in code that is in no notebook, such as in a box on a page of the site.

    Parameters
    ----------
    name : str
        A task, such as "gsolve".
    text : str
        Python code with its function. It can use what the assignment gives, such as `np`.
    draw : bool
        Whether differences are drawn as images.

    Returns
    -------
    result : Result
        The result, in the tier of `check`.

    Raises
    ------
    InputError
        For a name that is not a task.
    """
    homework, _ = find_tasks(name)
    cells = [closure.Cell(text, where=TEXT_NAME)]
    sources, problems = closure.extract_sources(cells, [name], reader.given_cells(homework.name))
    if not sources:
        # where the text is no Python, that is why the function is missing
        broken = [problem for problem in problems if problem.startswith(TEXT_NAME)]
        problems = broken or [f"{TEXT_NAME} defines no function {name}"]
    code = reader.SubmittedCode(
        sources=sources,
        problems=tuple(problems),
        hash="",
        modules=tuple(names.imported_numpy_modules(sources.values())),
    )
    tasks = tuple(task for task in homework.tasks if task.id == name)
    options = replace(PRACTICE, draw=draw)
    return last(grader.check_steps(code, homework._replace(tasks=tasks), options))


def _code_of_kernel(homework: plans.Homework, task_ids: Sequence[str]) -> reader.SubmittedCode:
    """Return the code of tasks from the cells that were run in this kernel."""
    given = reader.given_cells(homework.name)
    sources, _ = closure.extract_sources(_cells_of_kernel(), task_ids, given)
    missing = [task_id for task_id in task_ids if task_id not in sources]
    return reader.SubmittedCode(
        sources=sources,
        problems=tuple(f"{task_id} is not defined: run the cell with it" for task_id in missing),
        hash="",
        modules=tuple(names.imported_numpy_modules(sources.values())),
    )


def use_plan(
    name: str,
    at_most: float | None = None,
    *,
    plan: str | Path | None = None,
    variants: Mapping[str, str] | None = None,
    **points: float,
) -> None:
    """Tell `check` which tasks a homework has, and what they are worth.

    Parameters
    ----------
    name : str
        Name of the homework.
    at_most : float, optional
        Points that count at most, if the tasks give more.
    plan : path, optional
        The plan file with the instructor's own tasks; their checks are beside it. By default,
        hdrlab's plan.
    variants : dict, optional
        Variants of tasks that differ between students, by task.
    **points : float
        Points of each task. Without any, the homework is as the plan says.
    """
    course = plans.read(plan)
    tasks = tuple(
        course.task(task_id)._replace(points=float(worth)) for task_id, worth in points.items()
    )
    homework = course.homeworks.get(name)
    if homework is None:
        some_homework = next(iter(course.homeworks.values()))
        homework = some_homework._replace(name=name, title=name)
    if tasks:
        homework = homework._replace(tasks=tasks, at_most=at_most)
    _planned[name] = plans.draw_variants(homework, "", "", variants)


def find_tasks(name: str) -> tuple[plans.Homework, list[str]]:
    """Return the homework that a name belongs to, and the ids of the tasks that it means."""
    homeworks = dict(_planned)
    for known, homework in plans.read().homeworks.items():
        homeworks.setdefault(known, homework)
    if name in homeworks:
        return homeworks[name], [task.id for task in homeworks[name].tasks]
    for homework in homeworks.values():
        if name in [task.id for task in homework.tasks]:
            return homework, [name]
    tasks = ", ".join(task.id for homework in homeworks.values() for task in homework.tasks)
    raise InputError(
        f"expected a homework ({', '.join(homeworks)}) or a task ({tasks}), got {name!r}"
    )


def _shell() -> Any:
    """Return the shell of this kernel, None outside IPython."""
    from IPython.core.getipython import get_ipython

    return get_ipython()


def _cells_of_kernel() -> Sequence[closure.Cell]:
    """Return the text of each cell that was run in this kernel, in order."""
    shell = _shell()
    if shell is None:
        raise RuntimeError("check works in a notebook; at a terminal, use: hdrlab check FILE")
    inputs: list[str] = shell.history_manager.input_hist_raw
    return [
        closure.Cell(text, where=f"input {number}")
        for number, text in enumerate(inputs)
        if text.strip()
    ]
