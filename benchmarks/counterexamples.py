"""How small are the counterexamples of wrong answers, what do they cost, and can they be pasted?

The answers are the named mistakes, the plausible wrong ones of `fairness`, and those of `corpus`
that are not right. Each check that an answer fails for one student is a failed check. The search is
that of the grader, in the in-process tier, so that the processor time of this process is all that
it costs; it includes the tracing that ends endless loops there.

The text that the feedback offers is run in a new namespace that holds NumPy and the student's
function. It must give what the feedback shows as the student's value. A counterexample is wrong if a
right answer of `fairness/right` gives something else than what it calls correct.

`python -m benchmarks counterexamples` also prints every wrong answer without a counterexample, with
the reason, and the counterexamples with the most numbers and the most processor time.
"""

import ast
import inspect
import time
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from functools import cache
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from benchmarks import corpus, fairness
from benchmarks.experiments import Experiment, along, at_least, at_most
from hdrlab.course import plan
from hdrlab.course.checks import compare, counterexamples, snippets
from hdrlab.course.checks.subject import NoAnswer, Subject
from hdrlab.course.grading import grader, results
from hdrlab.course.limits import CALL_TIMEOUT_SECONDS
from hdrlab.course.sandbox import in_process, tiers
from hdrlab.course.source_code.names import imported_numpy_modules

STUDENT = "student 0"
MAX_MEDIAN_NUMBERS = 9
MAX_CPU_SECONDS = 5
MIN_SHOWN_PERCENT = 80
PRINTED_COUNT = 10


@dataclass(frozen=True, kw_only=True)
class WrongAnswer:
    """A wrong solution of a task, in the text of a notebook."""

    task: str
    name: str
    text: str


@dataclass(frozen=True, kw_only=True)
class FailedCheck:
    """A check that a wrong answer fails, and the counterexample that the feedback shows.

    Attributes
    ----------
    task, answer, check : names
    code : the lines to paste; "" without a counterexample
    reason : why there is no counterexample
    numbers : how many numbers are in the code
    cpu_seconds : of the search
    pasted : "" if the code gives the value that the feedback shows, otherwise what it gives
    contradicted_by : right answers to which the counterexample would object
    """

    task: str
    answer: str
    check: str
    code: str = ""
    reason: str = ""
    numbers: int = 0
    cpu_seconds: float = 0.0
    pasted: str = ""
    contradicted_by: tuple[str, ...] = ()


def wrong_answers() -> list[WrongAnswer]:
    """Return the named mistakes, the plausible wrong answers, and the wrong ones of the corpus."""
    from_corpus = corpus.answers()
    for (task, name), expected in corpus.due().items():
        if expected.full_marks:
            del from_corpus[task][name]
    groups = (fairness.mistakes(), fairness.texts("wrong"), from_corpus)
    return [
        WrongAnswer(task=task, name=name, text=text)
        for group in groups
        for task, texts in group.items()
        for name, text in texts.items()
    ]


def measure(_: Path) -> dict[str, Any]:
    """Return how small the counterexamples are, what they cost, and how many cannot be trusted."""
    answers = wrong_answers()
    checks_of_answers = along(failed_checks, answers, "answers")
    unexplained = 0
    for answer, checks in zip(answers, checks_of_answers, strict=True):
        if not any(check.code for check in checks):
            unexplained += 1
            print(f"  {answer.task} {answer.name}: no counterexample")
            for reason in _reasons(checks):
                print(f"    {reason}")
    checks = [check for checks in checks_of_answers for check in checks]
    shown = [check for check in checks if check.code]
    _print_largest(shown)
    for check in shown:
        if check.pasted:
            print(f"  {check.task} {check.answer}: pasted, {check.code!r} gives {check.pasted}")
        if check.contradicted_by:
            print(
                f"  {check.task} {check.answer}: {check.contradicted_by} contradict {check.code!r}"
            )
    numbers = [check.numbers for check in shown]
    seconds = [check.cpu_seconds for check in checks]
    return {
        "wrong answers": len(answers),
        "of which with a counterexample, %": 100 * (1 - unexplained / len(answers)),
        "failed checks, and those with a counterexample": (len(checks), len(shown)),
        "numbers in the input: median, 90 %, largest": np.quantile(numbers, (0.5, 0.9, 1)),
        "CPU s: median, largest": np.quantile(seconds, (0.5, 1)),
        "not reproduced by pasting": sum(bool(check.pasted) for check in shown),
        "contradicted by a right answer": sum(bool(check.contradicted_by) for check in shown),
    }


def _reasons(checks: list[FailedCheck]) -> list[str]:
    """Return why none of some failed checks has a counterexample, each reason once."""
    if not checks:
        return [f"it fails no check of {STUDENT}"]
    return list(dict.fromkeys(check.reason for check in checks))


def _print_largest(shown: list[FailedCheck]) -> None:
    """Print the counterexamples with the most numbers and those with the most processor time."""
    for check in sorted(shown, key=lambda check: -check.numbers)[:PRINTED_COUNT]:
        print(f"  {check.task} {check.answer}, {check.numbers} numbers: {check.code!r}")
    for check in sorted(shown, key=lambda check: -check.cpu_seconds)[:PRINTED_COUNT]:
        print(f"  {check.task} {check.answer}, {check.cpu_seconds:.1f} s: {check.code!r}")


def failed_checks(answer: WrongAnswer) -> list[FailedCheck]:
    """Return the checks that an answer fails for one student, with their counterexamples."""
    module = import_module(f"hdrlab.course.checks.specification.test_{answer.task}")
    failed = []
    for name, check in list(vars(module).items()):
        if not name.startswith("test_"):
            continue
        kind = _kind_of_failure(check, answer)
        if kind is not None:
            failed.append(_failed_check(module, name, answer, kind))
    return failed


def _failed_check(module: ModuleType, name: str, answer: WrongAnswer, kind: str) -> FailedCheck:
    """Return a failed check with its counterexample, if the grader would search for one."""
    if kind not in ("", "raised"):
        reason = f"the check failed in another way: {kind}"
        return FailedCheck(task=answer.task, answer=answer.name, check=name, reason=reason)
    solution = plan.function(plan.read().task(answer.task))
    run = _runner(getattr(module, name))
    example = None
    reason = ""
    started = time.process_time()
    with _subject(answer.task, answer.text) as subject:
        try:
            example = counterexamples.find(
                answer.task, module, run, subject, solution, raised=kind == "raised"
            )
        except counterexamples.NoCounterexample as error:
            reason = str(error)
        except Exception as error:  # the grader shows no counterexample then
            reason = f"the search failed: {type(error).__name__}: {error}"
    cpu_seconds = time.process_time() - started
    if example is None:
        return FailedCheck(
            task=answer.task,
            answer=answer.name,
            check=name,
            reason=reason,
            cpu_seconds=cpu_seconds,
        )
    snippet = snippets.Snippet(example.inputs, example.call)
    shown = grader.shown_counterexample(asdict(example))
    return FailedCheck(
        task=answer.task,
        answer=answer.name,
        check=name,
        code=shown.code,
        numbers=snippet.count,
        cpu_seconds=cpu_seconds,
        pasted=difference_of_pasted_code(answer, shown),
        contradicted_by=tuple(_contradicting(answer.task, module, solution, snippet)),
    )


def difference_of_pasted_code(answer: WrongAnswer, shown: results.Counterexample) -> str:
    """Return what a counterexample gives in a notebook with a student's function.

    Return "" if it is what the feedback shows.
    """
    notebook: dict[str, Any] = {}
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        exec("import numpy as np", notebook)
        exec(answer.text, notebook)
        try:
            *inputs, last = ast.parse(shown.code).body
            exec(compile(ast.Module(inputs, []), "cell", "exec"), notebook)
            value = eval(ast.unparse(last), notebook)
        except Exception as error:  # a student's function may raise anything
            message = f"{answer.task} raised {type(error).__name__}"
            has_same_error = shown.yours.startswith(message) and str(error) in shown.yours
            return "" if has_same_error else f"{type(error).__name__}: {error}"
    text = snippets.show(compare.plain(value))
    return "" if text == shown.yours else f"{text}, not {shown.yours}"


def _subject(task: str, text: str) -> Subject:
    modules = tuple(imported_numpy_modules([text]))
    return Subject({task: text}, tiers.choose(in_process.TIER), CALL_TIMEOUT_SECONDS, modules)


def _runner(check: Callable[..., object]) -> counterexamples.Run:
    names = inspect.signature(check).parameters

    def run(subject: Any, rng: np.random.Generator) -> None:
        arguments = {"subject": subject, "rng": rng}
        check(**{name: arguments[name] for name in names})

    return run


def _kind_of_failure(check: Callable[..., object], answer: WrongAnswer) -> str | None:
    """Return the kind of a failure, as `NoAnswer.kind`, "" for a wrong answer, None if the check holds."""
    compare.notes.clear()
    rng = np.random.default_rng(plan.seed("fairness", STUDENT, answer.task))
    with _subject(answer.task, answer.text) as subject:
        try:
            _runner(check)(subject, rng)
        except NoAnswer as error:
            return error.kind
        except Exception:  # whatever an answer leads to costs that promise
            return ""
    return None


@cache
def _right_answers(task: str) -> Mapping[str, str]:
    return fairness.texts("right").get(task, {})


def _contradicting(
    task: str, module: ModuleType, solution: Callable[..., Any], snippet: snippets.Snippet
) -> Iterator[str]:
    """Yield the names of the right answers that the counterexample would call wrong."""
    calls = [node for node in ast.walk(ast.parse(snippet.call)) if isinstance(node, ast.Call)]
    call = next(node for node in calls if getattr(node.func, "id", "") == task)
    args, kwargs = snippets.Snippet(snippet.inputs, ast.unparse(call)).arguments()
    for name, text in _right_answers(task).items():
        with _subject(task, text) as subject:
            search = counterexamples.Search(task, module, subject, solution, raised=False)
            # a right answer that cannot be called, or that is late, contradicts nothing
            with suppress(counterexamples.SearchEnded):
                if search.try_input(args, kwargs) is not None:
                    yield name


ROWS = (
    Experiment(
        "counterexamples",
        "the smallest counterexamples of all wrong answers",
        measure,
        (
            at_least("of which with a counterexample, %", MIN_SHOWN_PERCENT),
            at_most(
                "numbers in the input: median, 90 %, largest", MAX_MEDIAN_NUMBERS, np.inf, np.inf
            ),
            at_most("CPU s: median, largest", np.inf, MAX_CPU_SECONDS),
            at_most("not reproduced by pasting", 0),
            at_most("contradicted by a right answer", 0),
        ),
    ),
)
