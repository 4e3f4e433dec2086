"""Which well-known mistake an answer comes from: it agrees with a wrong function, and not with the library.

A mistake's name begins with the id of its task. It is a place of the solution written otherwise, in
`mistakes/changes.toml`. A task of an instructor's own has files beside it: a docstring that says to
the student what it is, and the wrong function. All are asked what the student was asked; wrong
functions are ours, and run here. Answers are compared in the gauge or scale that the checks leave
free.

call        (arguments, named arguments, answer): what a check asked, and what came; None where nothing came
difference  between two answers, relative: 0 is the same, 1 about as large as the answer itself
"""

import runpy
import tomllib
import warnings
from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from hdrlab.course import plan
from hdrlab.course.checks import MISTAKES, compare, rewording
from hdrlab.course.code import inline
from hdrlab.errors import InputError

Call = tuple[Sequence[Any], dict[str, Any], Any]
ROUNDING = 1e-3  # relative: so much may float32, or another solver, add to an answer
NEARER = (
    0.1  # the wrong answer explains all but this share of the student's difference to the library
)
MOST = 1e3  # a difference beyond all measure, as of another shape
CHANGES: dict[str, dict[str, Any]] = tomllib.loads((MISTAKES / "changes.toml").read_text("utf-8"))


class Misconception(NamedTuple):
    """A mistake: its name, the task, the sentence for the student, and the wrong function.

    `once` is whether it costs half of the task at most: all but those that miss what the task is
    about.
    """

    name: str
    task: str
    sentence: str
    function: Callable[..., Any]
    once: bool = True


@cache
def known() -> tuple[Misconception, ...]:
    """Return all mistakes there are."""
    return tuple(_of_variant(name, "") for name in sorted(CHANGES))


@cache
def _of_variant(name: str, variant: str) -> Misconception:
    task, one = task_of(name), CHANGES[name]
    says = rewording.reword(task, variant, one["says"])
    return Misconception(
        name, task, says, partial(_ask_changed, name, variant), "misses" not in one
    )


def of_task(task: plan.Task) -> Sequence[Misconception]:
    """Return the mistakes of a task: those that come with hdrlab, or with an instructor's own task."""
    if task.own is None:
        return [_of_variant(one.name, task.variant) for one in known() if one.task == task.id]
    files = sorted((task.own.parent / "mistakes").rglob(f"{task.id}_*.py"))
    return [_read(path, task.id) for path in files]


def _read(path: Path, task: str) -> Misconception:
    names = runpy.run_path(str(path))
    sentence = " ".join(names["__doc__"].split())
    return Misconception(path.stem, task, sentence, names[task], path.parent.name != "method")


def task_of(name: str) -> str:
    """Return the id of the task that a mistake is of: the longest that its name begins with.

    Examples
    --------
    >>> task_of("scale_steps_no_threshold"), task_of("scale_too_low")
    ('scale_steps', 'scale')
    """
    return max(
        (one.id for tasks in _sheets() for one in tasks if name.startswith(f"{one.id}_")), key=len
    )


@cache
def _sheets() -> list[tuple[plan.Task, ...]]:
    return [homework.tasks for homework in plan.read().homeworks.values()]


@cache
def solutions(tasks: tuple[plan.Task, ...]) -> Mapping[str, str]:
    """Return the library's text for each task of a homework, or its variant's: a cell that stands alone."""
    blocks = inline.inlined({task.id: task.function for task in tasks})
    return {
        task.id: rewording.reword(task.id, task.variant, blocks[task.id].text) for task in tasks
    }


def put_in(cells: Mapping[str, str], name: str, variant: str = "") -> dict[str, str]:
    """Return a homework's solutions, task by task, with one of CHANGES in its task's, of a variant.

    Raises
    ------
    ValueError
        Where what is to be changed does not stand there once.
    """
    task = task_of(name)
    text = cells[task]
    for change in CHANGES[name]["changes"]:
        was, now = (rewording.reword(task, variant, one) for one in change)
        if text.count(was) != 1:
            raise InputError(f"expected once in the solution of {task}, for {name}: {was}")
        text = text.replace(was, now)
    return {**cells, task: text}


@cache
def _changed(name: str, variant: str) -> Callable[..., Any]:
    task = task_of(name)
    tasks = next(tasks for tasks in _sheets() if task in [one.id for one in tasks])
    tasks = tuple(one._replace(variant=variant) if one.id == task else one for one in tasks)
    scope: dict[str, Any] = {"__name__": name}
    exec("\n\n\n".join(put_in(solutions(tasks), name, variant).values()), scope)
    return scope[task]


def _ask_changed(name: str, variant: str, *given: Any, **named: Any) -> Any:
    return _changed(name, variant)(*given, **named)


def closest(asked: plan.Task, calls: Sequence[Call]) -> Misconception | None:
    """Return the misconception whose answers are those of the student in every call, or None.

    Of several the nearest. An answer like the library's is no misconception, and neither is no
    answer at all.
    """
    calls = [(given, named, in_gauge(asked.id, came)) for given, named, came in calls]
    if all(came is None for _, _, came in calls):
        return None
    right = plan.function(asked)
    truths = [in_gauge(asked.id, call_quietly(right, given, named)) for given, named, _ in calls]
    far = [difference(call[2], truth) for call, truth in zip(calls, truths, strict=True)]
    mistakes = of_task(asked) if max(far) > ROUNDING else ()
    agreeing = [
        (score, one) for one in mistakes if (score := _distance(one, calls, far)) is not None
    ]
    return min(agreeing, key=lambda pair: pair[0])[1] if agreeing else None


def _of_states(came: Any) -> list[Any]:
    """Return f^-1 of each state, in shares of f^-1(128)."""
    found = [state[0] if isinstance(state, tuple | list) else state for state in came]
    return [f / f[128] for f in found]


GAUGES: dict[str, Callable[[Any], Any]] = {
    "hat": lambda w: w / w.max(),
    "gsolve": lambda both: tuple(one - both[0][len(both[0]) // 2] for one in both),
    "recover": lambda g: g - g[128],
    "recover_steps": _of_states,
    "solve": lambda u: u - u.mean(),
}


def in_gauge(task: str, answer: Any) -> Any:
    """Return an answer in the gauge or scale in which it is compared; one of another form as it is."""
    try:
        return GAUGES[task](
            compare.as_listed(answer) if task in ("hat", "recover", "solve") else answer
        )
    except Exception:  # which a student may answer in any form
        return answer


def _distance(one: Misconception, calls: Sequence[Call], far: Sequence[float]) -> float | None:
    """Return how far the student's answers are from the wrong ones in all, None where a call disagrees."""
    total = 0.0
    for (given, named, came), right in zip(calls, far, strict=True):
        near = difference(came, in_gauge(one.task, call_quietly(one.function, given, named)))
        if near > max(ROUNDING, NEARER * min(right, 1.0)):
            return None
        total += near
    return total


def call_quietly(function: Callable[..., Any], given: Sequence[Any], named: dict[str, Any]) -> Any:
    """Return what a trusted function answers, as plain arrays; None where it raises."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        try:
            return compare.plain(function(*given, **named))
        except Exception:  # a wrong function may fail in any way, and then it has no answer
            return None


def difference(a: Any, b: Any) -> float:
    """Return the root mean square of a - b over that of b, the largest over the parts of an answer.

    Examples
    --------
    >>> difference(np.ones(4), np.ones(4)), difference((np.ones(4), 3.0), (np.ones(4), 2.0))
    (0.0, 0.5)
    """
    if isinstance(b, tuple | list):
        if not isinstance(a, tuple | list) or len(a) != len(b):
            return MOST
        return max((difference(one, other) for one, other in zip(a, b, strict=True)), default=0.0)
    if a is None or b is None or isinstance(b, bytes | str):
        return 0.0 if type(a) is type(b) and a == b else MOST
    a = compare.as_listed(a) if isinstance(a, tuple | list) else a
    if isinstance(a, tuple | list | dict):  # which may be ragged
        return MOST
    a, b = np.asarray(a).squeeze(), np.asarray(b).squeeze()
    if a.shape != b.shape or a.dtype.kind not in "biuf" or b.dtype.kind not in "biuf":
        return MOST
    a, b = a.astype(np.float64), b.astype(np.float64)
    if np.any(np.isfinite(a) != np.isfinite(b)):
        return MOST
    both = np.isfinite(a)
    scale = np.sqrt(np.mean(b[both] ** 2)) if both.any() else 0.0
    apart = np.sqrt(np.mean((a - b)[both] ** 2)) if both.any() else 0.0
    return float(min(apart / scale, MOST)) if scale > 0 else (0.0 if apart == 0 else MOST)
