"""How small is the counterexample that a failed check shows, what does it cost, and is it true?

The answers are the named mistakes, the plausible wrong ones of `fairness`, and those of `corpus`
that are not right. Each check that an answer fails for one student is a loss. The search is that of
the grader, in the in-process tier, so that the processor time of this process is all that it costs;
it includes the tracing that ends endless loops there. A counterexample is wrong if a right answer of
`fairness/right` gives something else than what it calls correct.
"""

import ast
import inspect
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import cache
from importlib import import_module
from statistics import median
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

from benchmarks import fairness
from benchmarks.experiments import along
from hdrlab.course import plan
from hdrlab.course.checks import compare, counterexamples, snippets
from hdrlab.course.checks.subject import NoAnswer, Subject
from hdrlab.course.limits import CALL_TIMEOUT_SECONDS
from hdrlab.course.sandbox import in_process, tiers
from hdrlab.course.source_code.names import imported_numpy_modules

STUDENT = "student 0"


class Loss(NamedTuple):
    """A failed check, with its counterexample as code and the right answers that contradict it."""

    task: str
    way: str
    check: str
    code: str
    numbers: int
    cpu_seconds: float
    contradicted_by: tuple[str, ...]


def found(answers: Mapping[str, Mapping[str, str]]) -> list[Loss]:
    """Return the losses of answers: task -> way -> source."""
    items = [(task, way, text) for task, ways in answers.items() for way, text in ways.items()]
    return [loss for losses in along(_losses, items, "answers") for loss in losses]


def figures(losses: list[Loss]) -> dict[str, Any]:
    """Return what the losses show together, and print a line for each task."""
    for task in dict.fromkeys(loss.task for loss in losses):
        own = [loss for loss in losses if loss.task == task]
        shown = [loss for loss in own if loss.code]
        size = f"{median(loss.numbers for loss in shown):g}" if shown else "-"
        print(f"  {task:<24}{len(own):>4} losses{len(shown):>5} shown, numbers {size}")
    shown = [loss for loss in losses if loss.code]
    for loss in shown:
        if loss.contradicted_by:
            print(f"  {loss.task} {loss.way}: {loss.contradicted_by} contradict {loss.code}")
    seconds = [loss.cpu_seconds for loss in losses]
    return {
        "losses": len(losses),
        "with a counterexample, %": 100 * len(shown) / len(losses),
        "numbers, median": median(loss.numbers for loss in shown),
        "CPU s of a failed check, median and most": (median(seconds), max(seconds)),
        "contradicted by a right answer": sum(bool(loss.contradicted_by) for loss in shown),
    }


def _losses(item: tuple[str, str, str]) -> list[Loss]:
    """Return the losses of one answer."""
    task_id, way, text = item
    module = import_module(f"hdrlab.course.checks.specification.test_{task_id}")
    solution = plan.function(plan.read().task(task_id))
    losses = []
    for name, check in list(vars(module).items()):
        if not name.startswith("test_"):
            continue
        kind = _fails(check, task_id, text)
        if kind is None:
            continue
        started = time.process_time()
        example = None
        if kind in ("", "raised"):
            with _subject(task_id, text) as subject:
                example = counterexamples.find(
                    task_id, module, _runner(check), subject, solution, raised=kind == "raised"
                )
        cpu_seconds = time.process_time() - started
        code = ""
        numbers = 0
        contradicted_by: tuple[str, ...] = ()
        if example is not None:
            snippet = snippets.Snippet(example.inputs, example.call)
            code = snippet.text
            numbers = snippet.count
            contradicted_by = _contradicting(task_id, module, solution, snippet)
        losses.append(Loss(task_id, way, name, code, numbers, cpu_seconds, contradicted_by))
    return losses


def _subject(task_id: str, text: str) -> Subject:
    modules = tuple(imported_numpy_modules([text]))
    return Subject({task_id: text}, tiers.choose(in_process.TIER), CALL_TIMEOUT_SECONDS, modules)


def _runner(check: Callable[..., object]) -> counterexamples.Run:
    names = inspect.signature(check).parameters

    def run(subject: Any, rng: np.random.Generator) -> None:
        given = {"subject": subject, "rng": rng}
        check(**{name: given[name] for name in names})

    return run


def _fails(check: Callable[..., object], task_id: str, text: str) -> str | None:
    """Return the kind of a failure, as `NoAnswer.kind`, "" for a wrong answer, None if the check holds."""
    compare.notes.clear()
    rng = np.random.default_rng(plan.seed("fairness", STUDENT, task_id))
    with _subject(task_id, text) as subject:
        try:
            _runner(check)(subject, rng)
        except NoAnswer as error:
            return error.kind
        except Exception:  # whatever an answer leads to costs that promise
            return ""
    return None


@cache
def _right_answers(task_id: str) -> dict[str, str]:
    return fairness.texts("right").get(task_id, {})


def _contradicting(
    task_id: str, module: ModuleType, solution: Callable[..., Any], snippet: snippets.Snippet
) -> tuple[str, ...]:
    """Return the right answers that the counterexample would call wrong."""
    calls = [node for node in ast.walk(ast.parse(snippet.call)) if isinstance(node, ast.Call)]
    call = next(node for node in calls if getattr(node.func, "id", "") == task_id)
    args, kwargs = snippets.Snippet(snippet.inputs, ast.unparse(call)).arguments()
    ways = []
    for way, text in _right_answers(task_id).items():
        with _subject(task_id, text) as subject:
            search = counterexamples.Search(task_id, module, subject, solution, raised=False)
            # a right answer that cannot be called, or that is late, contradicts nothing
            with suppress(counterexamples.SearchEnded):
                if search.try_input(args, kwargs) is not None:
                    ways.append(way)
    return tuple(ways)
