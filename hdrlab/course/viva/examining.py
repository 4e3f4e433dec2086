"""The examiner's half of pytest: when the checks have run, questions are made of functions that pass them.

A question has four options, and each of them is the right one for some change of the student's
function. First four such changes are found, then one of the four is drawn and asked for: so the
options alone do not show which one is right. All answers come of two runs in the sandbox.

call    (arguments, named arguments, answer) of the student's own function, as a check has called it
value   of a version: what the options tell apart
"""

from collections.abc import Callable
from contextlib import suppress
from functools import cached_property
from operator import ne
from typing import Any, NamedTuple

import numpy as np
import pytest

from hdrlab.course.checks import misconceptions, plugin, subject
from hdrlab.course.sandbox import tiers
from hdrlab.course.viva import changed, inputs

KINDS = ("promise", "line", "part", "value", "picture")  # the rarest first
QUESTIONS, OPTIONS, TASKS = 5, 4, 5  # from so many tasks on, five are found if they can be
VERSIONS, CALLS, DRAWS = (
    (20, 80),
    2,
    20,
)  # that are tried at first, and again where questions are few
FEW, COMPARED = (
    2,
    8,
)  # versions that break a promise, if promises are to be told apart; calls compared
SAME = 1e-6  # relative: answers that are one
GIVEN, ANSWERED = 16, 6  # numbers of a call by hand, at most
SHARE, WORN = (
    0.3,
    0.6,
)  # of a check's seconds: what a call gets, and below what a sandbox is used up


class Found(NamedTuple):
    """What a question is made of: four versions, their values, how these came, and what a page shows."""

    versions: list[changed.Version]
    values: list[Any]
    view: Any
    differ: Any
    shown: dict[str, Any]


class Examining(plugin.Checking):
    """A run of the checks, and then of versions of what has passed them."""

    asking = False

    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        """Write down questions: of different kinds, and of different tasks while there are any."""
        self.asking, rng = True, np.random.default_rng(int(self.job["seed"]))
        self._begin()
        passed = [
            task for task in self.job["sources"] if self.calls.get(task) and task not in self.failed
        ]
        self._write(passed=passed)
        asked = {task: Asked(self, task, session.items, rng) for task in passed}
        pairs = [(kind, str(task)) for kind in KINDS for task in rng.permutation(passed)]
        left = [(most, *pair) for most in VERSIONS[: 1 + (len(passed) >= TASKS)] for pair in pairs]
        kinds, tasks = [""], [""]
        while left and len(tasks) <= QUESTIONS:
            most, kind, task = min(
                left, key=lambda one: (one[0], tasks.count(one[2]), kinds.count(one[1]))
            )
            left.remove((most, kind, task))
            asked[task].most = most
            if self.submission.left < WORN * self.job["timeout"]:
                self._begin()
            question = None
            with suppress(Exception):  # whatever it answers costs one question
                question = asked[task].question(kind)
            if question:
                left = [one for one in left if one[1:] != (kind, task)]
                kinds, tasks = [*kinds, kind], [*tasks, task]
                self._write(question=question)

    def _begin(self) -> None:
        """Take a new sandbox, in place of one whose time is nearly used up."""
        self.submission.__exit__()
        sandbox, seconds = tiers.choose(self.job["tier"]), SHARE * self.job["timeout"]
        one = subject.Subject(self.job["sources"], sandbox, seconds, self.job["modules"])
        self.submission = self.open.enter_context(one)

    def _ended(self, item: pytest.Item, raised: BaseException | None) -> None:
        self.raised = raised
        return None if self.asking else super()._ended(item, raised)


class Asked:
    """A task that is asked about, in a sandbox of its own; KINDS are methods."""

    def __init__(
        self, run: Examining, task: str, items: list[pytest.Item], rng: np.random.Generator
    ) -> None:
        self.run, self.task, self.rng, self.most = run, task, rng, VERSIONS[0]  # versions to try
        self.items = [one for one in items if plugin.task_of(one) == task]
        self.source = run.job["sources"][task]
        self.calls = [run.calls[task][k] for k in rng.permutation(len(run.calls[task]))]

    def question(self, kind: str) -> dict[str, Any] | None:
        """Return a question as a page shows it, or None where the task has none of this kind."""
        found: Found | None = getattr(self, kind)()
        right = int(self.rng.integers(OPTIONS))
        if found is None or not self.holds(found):
            return None
        versions = [one._asdict() for one in found.versions]
        return {
            "kind": kind,
            "task": self.task,
            "right": right,
            "versions": versions,
            **found.shown,
        }

    def holds(self, found: Found) -> bool:
        """Return whether each version has its value again, and none of the others, in a process of its own.

        What `numpy.empty` gives holds other numbers there: a version that shows them has no answer.
        """
        again = [
            found.view(one._replace(source=one.source + changed.FILLED)) for one in found.versions
        ]
        same = [[a is not None and not found.differ(a, b) for b in found.values] for a in again]
        return bool(np.array_equal(same, np.eye(OPTIONS)))

    def promise(self) -> Found | None:
        """Ask which of these promises, in this order, a version breaks first."""
        versions, broken, known = [], [], []
        for version in self._versions()[: self.most // 2]:
            failed = self._broken(version)
            if failed is None or (not failed and self._is_same(version.source)):
                continue
            versions.append(version)
            broken.append(failed)
            every = sorted(
                set().union(*broken), key=lambda one: (sum(one in each for each in broken), one)
            )
            first = [next((one for one in every if one in each), "") for each in broken]
            known = [one for one in [*every, ""] if one in first]
            if len(known) >= OPTIONS or len(versions) > FEW * len(known) + 1:
                break
        if len(known) < OPTIONS:
            return None
        chosen = [known[k] for k in sorted(self.rng.choice(len(known), OPTIONS, replace=False))]

        def view(version: changed.Version) -> str | None:
            failed = self._broken(version)
            return None if failed is None else next((one for one in chosen if one in failed), "")

        at = [first.index(one) for one in chosen]
        more = {"broken": [sorted(broken[k]) for k in at], "call": self._told(self.calls[0])}
        return Found([versions[k] for k in at], chosen, view, ne, {"texts": chosen} | more)

    def line(self) -> Found | None:
        """Ask which of three lines could be taken out without changing any answer."""
        idle = changed.unused(self.source)
        for _ in range(DRAWS * (len(idle) >= OPTIONS - 1)):
            lines = sorted(self.rng.choice(list(idle), OPTIONS - 1, replace=False).tolist())
            versions = [
                changed.Version(text, text) for text in (*(idle[k] for k in lines), self.source)
            ]
            texts = [[one.source.split("\n")[k - 1].strip() for k in lines] for one in versions]
            if texts.count(texts[0]) == OPTIONS:  # else what is written out shows in an option
                break
        else:
            return None

        def view(version: changed.Version) -> int | None:
            gone = [k for k in lines if self._is_same(changed.without(version.source, k))]
            return sum(gone) if len(gone) < 2 and self._is_same(version.source) else None

        if [view(one) for one in versions] != [*lines, 0]:
            return None
        return Found(versions, [*lines, 0], view, ne, {"lines": lines, "texts": texts[0]})

    def part(self) -> Found | None:
        """Ask in which part of a photograph, or of a curve, an answer changes most."""
        return self._drawn("marks", inputs.gaps, inputs.elsewhere, lambda gaps: int(gaps.argmax()))

    def picture(self) -> Found | None:
        """Ask which of four pictures or curves a version draws."""
        return self._drawn("figures", inputs.levels, inputs.visible, inputs.figure)

    def value(self) -> Found | None:
        """Ask what a call returns."""
        for call in [one for one in self.calls if inputs.count(inputs.small(one[:2])) <= GIVEN][
            :CALLS
        ]:
            args, kwargs = inputs.small(call[:2])

            def view(version: changed.Version, given: Any = (args, kwargs)) -> Any:
                came = self._answer(version.source, given)
                return came if inputs.is_readable(came, ANSWERED) else None

            own = view(changed.Version(self.source, self.source))
            if own is not None and (found := self._four(view, inputs.apart)):
                texts = [*map(inputs.told, found.values)]
                return found._replace(shown={"call": self._told((args, kwargs)), "texts": texts})
        return None

    def _drawn(
        self, named: str, see: Callable[[Any, Any], Any], differ: Any, tell: Any
    ) -> Found | None:
        """Return four versions whose drawn answers differ; a photograph takes the place of images."""
        photos = self.run.job["photographs"]
        for call in [one for one in self.calls if inputs.shown(one[2]) is not None][:CALLS]:
            given = inputs.photographed(
                call[:2], np.array(photos[self.rng.integers(len(photos))], np.uint8)
            )
            own = inputs.shown(self._answer(self.source, given))
            if own is None or own.min() == own.max():
                continue

            def view(version: changed.Version, given: Any = given, own: Any = own) -> Any:
                came = inputs.shown(self._answer(version.source, given))
                return None if came is None or came.shape != own.shape else see(came, own)

            if found := self._four(view, differ):
                image = inputs.shown(given[0])
                figures = (
                    {"own": own}
                    if image is None or image.ndim == 1
                    else {"given": image, "own": own}
                )
                shown = {
                    name: inputs.figure(inputs.levels(one, one)) for name, one in figures.items()
                }
                more = {"call": self._told(given), "scale": inputs.scale(own)}
                return found._replace(shown=shown | more | {named: [*map(tell, found.values)]})
        return None

    def _four(self, view: Any, differ: Any) -> Found | None:
        """Return the first four versions, as they are drawn, whose values differ, also from the own."""
        found, own = (
            Found([], [], view, differ, {}),
            view(changed.Version(self.source, self.source)),
        )
        for version in self._versions():
            value = view(version)
            if value is not None and all(
                differ(value, one) for one in [own, *found.values] if one is not None
            ):
                found.versions.append(version)
                found.values.append(value)
            if len(found.values) == OPTIONS:
                return found
        return None

    def _told(self, call: Any) -> str:
        return inputs.called(
            self.task, changed.parameters(self.source, self.task), call[0], call[1], GIVEN
        )

    def _versions(self) -> list[changed.Version]:
        return [self.every[k] for k in self.rng.permutation(len(self.every))[: self.most]]

    @cached_property
    def every(self) -> list[changed.Version]:
        """Every version of the task."""
        return changed.versions(self.source)

    def _answer(self, source: str, call: Any) -> Any:
        """Return what a version answers, None where it does not."""
        self.run.submission.fresh(**{self.task: source})
        return self._asked(call)

    def _asked(self, call: Any) -> Any:
        try:
            return getattr(self.run.submission, self.task)(*call[0], **call[1])
        except subject.NoAnswer:
            return None

    def _is_same(self, source: str) -> bool:
        """Return whether a version answers what the student's own function has answered to the checks."""
        calls = sorted(self.run.calls[self.task], key=lambda call: inputs.count(call[:2]))[
            :COMPARED
        ]
        self.run.submission.fresh(**{self.task: source})
        return all(misconceptions.difference(self._asked(call), call[2]) <= SAME for call in calls)

    def _broken(self, version: changed.Version) -> set[str] | None:
        """Return the promises that a version breaks, None where the time that it takes has a say."""
        self.run.submission.fresh(**{self.task: version.source})
        broken = set()
        for item in self.items:
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=None)
            raised = self.run.raised
            if isinstance(raised, subject.NoAnswer) and raised.kind not in ("raised", "refused"):
                return None
            broken |= {plugin.promise_of(item)} if raised else set()
        return broken
