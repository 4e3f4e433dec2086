"""The grader's pytest plugin: it runs the specification on a student's code and writes the results.

The specification's files call `subject.gsolve(...)`. In hdrlab's own tests the subject is the
library. Here it is a student's code in another process. A JSON file, the job, says what to check.
The plugin writes each result into another file as soon as it is known, so nothing is lost if this
process is killed.
"""

import base64
import inspect
import json
import re
import time
import warnings
from collections.abc import Callable
from contextlib import ExitStack, suppress
from dataclasses import asdict
from fractions import Fraction
from functools import partial
from pathlib import Path
from pkgutil import resolve_name
from typing import Any

import numpy as np
import pytest

from hdrlab.core.arrays import describe
from hdrlab.course import plan
from hdrlab.course.checks import compare, counterexamples, inprocess, misconceptions
from hdrlab.course.checks.subject import NoAnswer, Subject
from hdrlab.course.sandbox import in_process, tiers
from hdrlab.course.sandbox.inside import system
from hdrlab.course.sandbox.session import Unavailable

MAX_MESSAGE_CHARACTERS = 1500
# why a check has no answer, where the student's code was never called or has no time left
NOT_TRIED_AGAIN = ("missing", "late", "killed")
# how a check may fail so that a counterexample is looked for: by a wrong answer, or an exception
EXPLICABLE_KINDS = ("", "raised")
# processor time of this process for the counterexamples of a submission; no search begins after it.
# The guarantees in SECURITY.md contain it.
ALL_SEARCHES_CPU_SECONDS = 8.0
# of what a function printed
MAX_PRINTED_CHARACTERS = 4000
# values of an image that is drawn
MAX_DRAWN_VALUES = 3_000_000
POINTS_MARKER = (
    "points(n, needs=''): the points of a promise, and the check without which it earns nothing"
)
# the start of what pytest appends to the message of a plain assert
ASSERT_DETAILS = re.compile(r"\n *\+  where")
# the address of an object, which differs from run to run
MEMORY_ADDRESS = re.compile(r" at 0x[0-9a-fA-F]+")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option with the name of the job's file."""
    parser.addoption("--job", help="JSON file that says what to check, and how")


def pytest_configure(config: pytest.Config) -> None:
    """Register the marker of the specification, and the plugin that the job names."""
    config.addinivalue_line("markers", POINTS_MARKER)
    job = json.loads(Path(config.getoption("--job")).read_text(encoding="utf8"))
    config.pluginmanager.register(resolve_name(job["by"])(job), "hdrlab-checking")


class Missing:
    """The subject of a task that was not handed in, or took too long: every call raises NoAnswer."""

    printed = ""

    def __init__(self, kind: str = "missing") -> None:
        self._kind = kind

    def __getattr__(self, name: str) -> Any:
        raise NoAnswer("", self._kind)


class GradingPlugin:
    """One run of the checks: read the job, run the subject, write the results."""

    def __init__(self, job: dict[str, Any]) -> None:
        self.job = job
        self.open = ExitStack()
        self.calls: dict[str, list[misconceptions.CheckedCalls]] = {}
        self.failed: set[str] = set()
        # public checks that failed with an answer, or by an exception of the student's function
        self.explicable: list[tuple[pytest.Function, bool]] = []
        self.late: set[str] = set()

    def pytest_sessionstart(self) -> None:
        """Start the sandbox, which gets ready while pytest collects the checks."""
        has_process = self.job["tier"] != in_process.TIER
        # if the grader is killed, this process is to end, too
        if has_process and not system.die_with_parent(self.job["grader"]):
            pytest.exit("the grader has ended")
        sandbox = tiers.choose(self.job["tier"])
        subject = Subject(self.job["sources"], sandbox, self.job["timeout"], self.job["modules"])
        self.submission = self.open.enter_context(subject)

    @pytest.fixture
    def subject(self, request: pytest.FixtureRequest) -> Subject | Missing:
        """Return the student's functions in a fresh process, so that no check affects the next one."""
        if task_of(request.node) not in self.job["sources"]:
            return Missing()
        if task_of(request.node) in self.late:
            return Missing("late")
        self.submission.fresh()
        compare.notes.clear()
        return self.submission

    @pytest.fixture
    def rng(self, request: pytest.FixtureRequest) -> np.random.Generator:
        """Return the random generator of this student's inputs to this task."""
        return self._random_generator(task_of(request.node))

    def _random_generator(self, task: str) -> np.random.Generator:
        """Return the random generator of this student's inputs to a task, at its start."""
        return np.random.default_rng(int(self.job["seeds"].get(task, 0)))

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        """Write a line for every check before the first one runs."""
        for item in session.items:
            worth = item.get_closest_marker("points")
            self._write(
                check=_id(item),
                task=task_of(item),
                name=_name(item),
                promise=promise_of(item),
                points=str(Fraction(str(worth.args[0] if worth else 1))),
                needs=worth.kwargs.get("needs", "") if worth else "",
                hints=hints(getattr(item, "function", None)),
                hidden=self._is_hidden(item),
            )

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self, item: pytest.Item, call: pytest.CallInfo[None]) -> Any:
        """Write a line when a check has ended."""
        report = yield
        if call.when == "call" or call.excinfo is not None:
            self._ended(item, call.excinfo and call.excinfo.value)
        return report

    def _ended(self, item: pytest.Item, raised: BaseException | None) -> None:
        subject = getattr(item, "funcargs", {}).get("subject", Missing())
        printed = MEMORY_ADDRESS.sub("", subject.printed[:MAX_PRINTED_CHARACTERS])
        if not self._is_hidden(item) and isinstance(subject, Subject):
            self._keep_calls(task_of(item), subject, holds=raised is None)
        if isinstance(raised, Unavailable):  # the machine failed, not the submission
            return self._write(unavailable=str(raised))
        if raised is None:
            notes = "\n".join(dict.fromkeys(compare.notes))[:MAX_MESSAGE_CHARACTERS]
            return self._write(ended=_id(item), outcome="holds", message=notes, printed=printed)
        kind = raised.kind if isinstance(raised, NoAnswer) else ""
        problem = "" if kind in NOT_TRIED_AGAIN else self._problem_of_check(item)
        if problem:
            return self._write(ended=_id(item), outcome="broken", message=problem, printed=printed)
        if not self._is_hidden(item):
            self.failed.add(task_of(item))
            if kind in EXPLICABLE_KINDS and isinstance(item, pytest.Function):
                self.explicable.append((item, kind == "raised"))
        if kind == "late":
            self.late.add(task_of(item))
        self._write(
            ended=_id(item),
            outcome="no answer" if kind else "fails",
            kind=kind,
            message=_message(raised),
            differs=_differs(raised) if self.job["draw"] else None,
            printed=printed,
        )

    def _keep_calls(self, task_id: str, subject: Subject, *, holds: bool) -> None:
        """Keep the calls that a check has made, to recognize a mistake."""
        kept = self.calls.setdefault(task_id, [])
        room = misconceptions.MAX_COMPARED_CALLS - sum(len(check.calls) for check in kept)
        calls = [(call.args, call.kwargs, call.answer) for call in subject.calls[:room]]
        kept.append(misconceptions.CheckedCalls(calls=calls, holds=holds))

    def calls_of(self, task_id: str) -> list[misconceptions.Call]:
        """Return the calls of a task that were kept, of all checks."""
        return [call for check in self.calls.get(task_id, []) for call in check.calls]

    def _problem_of_check(self, item: pytest.Item) -> str:
        """Return what is wrong with a check itself, or "" if the solution passes it.

        The check runs once more, with the solution in place of the student's function and the same
        inputs. If it does not hold then, its failure says nothing about the student.
        """
        if not isinstance(item, pytest.Function):
            return ""
        names = inspect.signature(item.obj).parameters
        arguments = {name: item.funcargs.get(name) for name in names}
        if not isinstance(arguments.get("subject"), Subject):
            return ""
        functions = self._find_solutions()
        if task_of(item) not in functions:
            return ""
        notes = list(compare.notes)
        try:
            arguments["subject"] = inprocess.Subject(functions)
            if "rng" in arguments:
                arguments["rng"] = self._random_generator(task_of(item))
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                item.obj(**arguments)
        except Exception as error:
            reason = f"{type(error).__name__}: {error}"[:MAX_MESSAGE_CHARACTERS]
            return (
                "This check is broken: it does not hold for the solution either, so it costs no "
                f"points. Please report it to your instructor. ({reason})"
            )
        finally:
            compare.notes[:] = notes
        return ""

    def _find_solutions(self) -> dict[str, Callable[..., Any]]:
        """Return the function that solves each task; an instructor may have written none."""
        functions = {}
        for values in self.job["tasks"]:
            task = plan.Task(*values)
            with suppress(Exception):  # an instructor's own file may do anything
                functions[task.id] = plan.function(task)
        return functions

    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        """Write a line for each task whose answers show known mistakes."""
        tasks = {task.id: task for task in (plan.Task(*values) for values in self.job["tasks"])}
        for task_id in sorted(self.failed):
            # an answer that breaks the search costs this task its sentence, and no other task
            with suppress(Exception):
                diagnosis = misconceptions.diagnose(tasks[task_id], self.calls.get(task_id, []))
                if diagnosis.mistakes:
                    self._write(
                        recognised=task_id,
                        sentence=diagnosis.sentence,
                        explains_all=diagnosis.explains_all,
                        once=diagnosis.costs_half_at_most,
                    )
        functions = self._find_solutions()
        deadline = time.process_time() + ALL_SEARCHES_CPU_SECONDS
        for item, raised in self.explicable:
            if time.process_time() > deadline:
                return
            # all checks have ended: nothing that the search does changes their outcomes
            with suppress(Exception):
                self._find_counterexample(item, functions, raised=raised)

    def _find_counterexample(
        self, item: pytest.Function, functions: dict[str, Callable[..., Any]], *, raised: bool
    ) -> None:
        """Write a line with the smallest input for which a check's function answers wrongly."""
        task_id = task_of(item)
        if task_id in self.late or task_id not in functions:
            return
        example = counterexamples.find(
            task_id,
            item.module,
            partial(_run_check, item),
            self.submission,
            functions[task_id],
            raised=raised,
        )
        self._write(counterexample=_id(item), **asdict(example))

    def pytest_unconfigure(self) -> None:
        """Close the sandbox."""
        self.open.close()

    def _is_hidden(self, item: pytest.Item) -> bool:
        return str(item.path.parent) == self.job["hidden"]

    def _write(self, **line: Any) -> None:
        with open(self.job["out"], "a", encoding="utf8") as out:
            out.write(json.dumps(line) + "\n")


def _run_check(item: pytest.Function, subject: Any, rng: np.random.Generator) -> None:
    """Run a check on a subject, with inputs from a random generator."""
    callspec = getattr(item, "callspec", None)
    arguments = dict(callspec.params) if callspec else {}
    arguments |= {"subject": subject, "rng": rng}
    names = inspect.signature(item.obj).parameters
    item.obj(**{name: arguments[name] for name in names})


def _id(item: pytest.Item) -> str:
    """Return an id of a check that is unique; pytest's own may be the same for files of two folders."""
    return f"{item.path}::{item.name}"


def task_of(item: pytest.Item) -> str:
    """Return the id of the task that a check belongs to."""
    return item.path.stem.removeprefix("test_")


def _name(item: pytest.Item) -> str:
    return item.originalname if isinstance(item, pytest.Function) else item.name


def promise_of(item: pytest.Item) -> str:
    """Return the promise in words, which is the name of the check."""
    words = _name(item).removeprefix("test_").replace("_", " ")
    return words[:1].upper() + words[1:]


def hints(check: object) -> list[str]:
    """Return the hints of a check, the paragraphs of its docstring. Each says more than the last."""
    paragraphs = (inspect.getdoc(check) or "").split("\n\n")
    return [" ".join(paragraph.split()) for paragraph in paragraphs if paragraph]


def _message(raised: BaseException) -> str:
    """Return the message for a check that does not hold."""
    message = MEMORY_ADDRESS.sub("", ASSERT_DETAILS.split(str(raised))[0]).strip()
    if (
        isinstance(raised, compare.AnswerMismatch)
        and raised.answer is not None
        and np.ndim(raised.answer)
    ):
        return f"{message[:MAX_MESSAGE_CHARACTERS]}\nYours: {describe(raised.answer)}"
    if isinstance(raised, AssertionError):
        empty = "" if isinstance(raised, NoAnswer) else "The check failed"
        return (message or empty)[:MAX_MESSAGE_CHARACTERS]
    return f"The answer could not be compared: {type(raised).__name__}: {message}"[
        :MAX_MESSAGE_CHARACTERS
    ]


def _differs(raised: BaseException) -> dict[str, Any] | None:
    """Return the two arrays of a difference that can be drawn, as text, or None."""
    if not isinstance(raised, compare.AnswerMismatch) or raised.kind == "values":
        return None
    if raised.expected is None or raised.answer is None or raised.expected.size > MAX_DRAWN_VALUES:
        return None
    return {
        "kind": raised.kind,
        "shape": raised.expected.shape,
        "expected": _encode(raised.expected),
        "answer": _encode(raised.answer),
    }


def _encode(array: np.ndarray) -> str:
    """Return an array as base 64 of little-endian float64."""
    return base64.b64encode(np.asarray(array, "<f8").tobytes()).decode()
