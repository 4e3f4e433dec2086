"""The grader's half of pytest: it gives the specification its subject, and writes down what became of it.

The specification's files say `subject.gsolve(...)`. In the tests of hdrlab that is the library;
here it is a student's code in another process. What is asked for stands in a job, a JSON file; what
comes of it is written line by line into another, so that nothing is lost if this process is ended.
"""

import base64
import inspect
import json
import re
from contextlib import ExitStack, suppress
from fractions import Fraction
from pathlib import Path
from pkgutil import resolve_name
from typing import Any

import numpy as np
import pytest

from hdrlab.core.arrays import describe
from hdrlab.course import plan
from hdrlab.course.checks import compare, misconceptions
from hdrlab.course.checks.subject import NoAnswer, Subject
from hdrlab.course.sandbox import running, tiers
from hdrlab.course.sandbox.inside import system

CALLS = 20  # of a task that are kept to recognise a mistake by
LONGEST = 1500  # characters of a message
SAID = 4000  # characters of what a function printed
MARKER = "points(n, needs=''): what a promise is worth, and the one without which it earns nothing"
WHERE = re.compile(r"\n *\+  where")  # begins what pytest adds to a plain assert
ADDRESS = re.compile(r" at 0x[0-9a-fA-F]+")  # of an object: it is another in each run
DRAWN = 3_000_000  # values of an image that is drawn, at most


def pytest_addoption(parser: pytest.Parser) -> None:
    """Take the name of the job's file."""
    parser.addoption("--job", help="JSON: what is to be checked, and how")


def pytest_configure(config: pytest.Config) -> None:
    """Read the job and who does it, and know the specification's marker."""
    config.addinivalue_line("markers", MARKER)
    job = json.loads(Path(config.getoption("--job")).read_text(encoding="utf8"))
    config.pluginmanager.register(resolve_name(job["by"])(job), "hdrlab-checking")


class Missing:
    """The subject of a task that was not handed in, or that took too long: nothing is asked of it."""

    said = ""

    def __init__(self, kind: str = "missing") -> None:
        self._kind = kind

    def __getattr__(self, name: str) -> Any:
        raise NoAnswer("", self._kind)


class GradingPlugin:
    """One run of the checks: the job, the subject, and what is written down."""

    def __init__(self, job: dict[str, Any]) -> None:
        self.job, self.open = job, ExitStack()
        self.calls: dict[str, list[tuple[Any, ...]]] = {}
        self.failed: set[str] = set()
        self.late: set[str] = set()

    def pytest_sessionstart(self) -> None:
        """Start the sandbox first: it gets ready while the checks are collected."""
        if not system.end_with(self.job["grader"]):  # if it is killed, this is to end, too
            pytest.exit("the grader has ended")
        sources, sandbox = self.job["sources"], tiers.choose(self.job["tier"])
        subject = Subject(sources, sandbox, self.job["timeout"], self.job["modules"])
        self.submission = self.open.enter_context(subject)

    @pytest.fixture
    def subject(self, request: pytest.FixtureRequest) -> Subject | Missing:
        """Return the student's functions, afresh: nothing that one check left behind serves the next."""
        if task_of(request.node) not in self.job["sources"]:
            return Missing()
        if task_of(request.node) in self.late:
            return Missing("late")
        self.submission.fresh()
        compare.notes.clear()
        return self.submission

    @pytest.fixture
    def rng(self, request: pytest.FixtureRequest) -> np.random.Generator:
        """Return what this student's inputs to this task are drawn from."""
        return np.random.default_rng(int(self.job["seeds"].get(task_of(request.node), 0)))

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        """Write down every check before the first is run."""
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
        """Write down how a check ended."""
        report = yield
        if call.when == "call" or call.excinfo is not None:
            self._ended(item, call.excinfo and call.excinfo.value)
        return report

    def _ended(self, item: pytest.Item, raised: BaseException | None) -> None:
        subject = getattr(item, "funcargs", {}).get("subject", Missing())
        said = ADDRESS.sub("", subject.said[:SAID])
        if not self._is_hidden(item) and isinstance(subject, Subject):
            kept = self.calls.setdefault(task_of(item), [])
            kept += [
                (one.args, one.kwargs, one.answer) for one in subject.calls[: CALLS - len(kept)]
            ]
        if isinstance(raised, running.Unavailable):  # nothing can be said of the submission
            return self._write(unavailable=str(raised))
        if raised is None:
            notes = "\n".join(dict.fromkeys(compare.notes))[:LONGEST]
            return self._write(ended=_id(item), outcome="holds", message=notes, said=said)
        if not self._is_hidden(item):
            self.failed.add(task_of(item))
        kind = raised.kind if isinstance(raised, NoAnswer) else ""
        if kind == "late":
            self.late.add(task_of(item))
        told = {"outcome": "no answer" if kind else "fails", "kind": kind}
        differs = _differs(raised) if self.job["draw"] else None
        self._write(ended=_id(item), **told, message=_message(raised), differs=differs, said=said)

    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        """Write down which well-known mistakes the answers show."""
        for task in sorted(self.failed):
            with suppress(
                Exception
            ):  # whatever was answered costs this task its sentence, and no other
                (asked,) = (plan.Task(*one) for one in self.job["tasks"] if one[0] == task)
                if found := misconceptions.closest(asked, self.calls.get(task, [])):
                    self._write(
                        recognised=task, sentence=found.sentence, once=found.costs_half_at_most
                    )

    def pytest_unconfigure(self) -> None:
        """Close the sandbox."""
        self.open.close()

    def _is_hidden(self, item: pytest.Item) -> bool:
        return str(item.path.parent) == self.job["hidden"]

    def _write(self, **line: Any) -> None:
        with open(self.job["out"], "a", encoding="utf8") as out:
            out.write(json.dumps(line) + "\n")


def _id(item: pytest.Item) -> str:
    """Return what tells a check from all others; pytest's own id may be the same for files of two folders."""
    return f"{item.path}::{item.name}"


def task_of(item: pytest.Item) -> str:
    """Return the id of the task that a check is of."""
    return item.path.stem.removeprefix("test_")


def _name(item: pytest.Item) -> str:
    return item.originalname if isinstance(item, pytest.Function) else item.name


def promise_of(item: pytest.Item) -> str:
    """Return the promise in words, which is the name of the check."""
    words = _name(item).removeprefix("test_").replace("_", " ")
    return words[:1].upper() + words[1:]


def hints(check: object) -> list[str]:
    """Return the hints of a check, from a nudge to nearly the answer: the paragraphs of its docstring."""
    return [" ".join(one.split()) for one in (inspect.getdoc(check) or "").split("\n\n") if one]


def _message(raised: BaseException) -> str:
    """Return why a check does not hold, in words."""
    said = ADDRESS.sub("", WHERE.split(str(raised))[0]).strip()
    if isinstance(raised, compare.Different) and raised.came is not None and np.ndim(raised.came):
        return f"{said[:LONGEST]}\nYours: {describe(raised.came)}"
    if isinstance(raised, AssertionError):
        empty = "" if isinstance(raised, NoAnswer) else "The promise does not hold"
        return (said or empty)[:LONGEST]
    return f"The answer could not be compared: {type(raised).__name__}: {said}"[:LONGEST]


def _differs(raised: BaseException) -> dict[str, Any] | None:
    """Return the two arrays of a difference that can be drawn, as text."""
    if not isinstance(raised, compare.Different) or raised.kind == "values":
        return None
    if raised.expected is None or raised.came is None or raised.expected.size > DRAWN:
        return None
    both = [np.asarray(one, "<f8") for one in (raised.expected, raised.came)]
    texts = [base64.b64encode(one.tobytes()).decode() for one in both]
    return {"kind": raised.kind, "shape": both[0].shape, "expected": texts[0], "came": texts[1]}
