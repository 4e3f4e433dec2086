"""Make questions on the student's functions that passed their checks, in the grader's pytest process.

A question has four options. Each option is right for one changed version of the student's function.
First four such versions are found. Then one of the four is drawn, and the question asks about it. So
the options alone do not show which one is right. Each answer is computed twice, in two sandboxes.

call    (arguments, keyword arguments, answer) of the student's own function in one of the checks
value   of a version: what its option shows
view    function that returns the value of a version, or None if it has none
"""

from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from functools import cached_property, partial
from operator import ne
from typing import Any

import numpy as np
import pytest

from hdrlab.course.checks import misconceptions, plugin, subject
from hdrlab.course.sandbox import tiers
from hdrlab.course.viva import changed, inputs

# kinds of questions, the rarest first
KINDS = ("promise", "line", "part", "value", "picture")
MAX_QUESTIONS = 5
OPTIONS_PER_QUESTION = 4
# with as many passing tasks, a search that found too few questions is repeated with more versions
MIN_TASKS_FOR_SECOND_SEARCH = 5
# versions that the first search tries, and the second
VERSIONS_PER_SEARCH = (20, 80)
# calls of the checks that are tried for one question
MAX_CALLS = 2
# random choices of three lines that are tried
MAX_LINE_DRAWS = 20
# versions tried for each promise that is told apart; beyond, the search gives up
MAX_VERSIONS_PER_PROMISE = 2
# calls on which a version is compared with the student's function
MAX_COMPARED_CALLS = 8
# relative difference of two answers that count as the same
SAME_ANSWER = 1e-6
# numbers in the arguments, and in the answer, of a call that is worked out by hand
MAX_ARGUMENT_NUMBERS = 16
MAX_ANSWER_NUMBERS = 6
# seconds of a call, as a fraction of those of a check's call
CALL_TIME_FRACTION = 0.3
# seconds left in a sandbox, as a fraction of those of a check's call, below which it is replaced
MIN_TIME_LEFT = 0.6
# the option of a version that breaks none of the promises
NO_PROMISE = ""

View = Callable[[changed.Version], Any]


@dataclass(frozen=True)
class Candidate:
    """A question to try: its kind, its task, and how many versions may be tried for it."""

    max_versions: int
    kind: str
    task: str


@dataclass(frozen=True, kw_only=True)
class QuestionDraft:
    """Four versions whose values differ.

    Attributes
    ----------
    versions : one for each option
    values : the value of each version
    view : computes the value of a version
    differ : whether two values count as different
    shown : what else the page of the question shows
    """

    versions: list[changed.Version]
    values: list[Any]
    view: View
    differ: Callable[[Any, Any], Any]
    shown: dict[str, Any]


class Examining(plugin.GradingPlugin):
    """Run the checks, and then make questions of the tasks that passed."""

    is_asking = False

    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        """Write at most five questions, of different kinds and tasks as far as there are any."""
        self.is_asking = True
        rng = np.random.default_rng(int(self.job["seed"]))
        self._replace_sandbox()
        passed = [
            task for task in self.job["sources"] if self.calls_of(task) and task not in self.failed
        ]
        self._write(passed=passed)
        generators = {task: QuestionGenerator(self, task, session.items, rng) for task in passed}
        candidates = make_candidates(passed, rng)
        questions: list[dict[str, Any]] = []
        while candidates and len(questions) < MAX_QUESTIONS:
            candidate = least_asked(candidates, questions)
            candidates.remove(candidate)
            question = self._try_to_ask(generators[candidate.task], candidate)
            if question is None:
                continue
            questions.append(question)
            self._write(question=question)
            candidates = [
                other
                for other in candidates
                if (other.kind, other.task) != (candidate.kind, candidate.task)
            ]

    def _try_to_ask(
        self, generator: "QuestionGenerator", candidate: Candidate
    ) -> dict[str, Any] | None:
        """Return the candidate's question, or None if there is none or the student's code fails."""
        if self.submission.seconds_left < MIN_TIME_LEFT * self.job["timeout"]:
            self._replace_sandbox()
        with suppress(Exception):  # whatever a version answers costs one question
            return generator.question(candidate.kind, candidate.max_versions)
        return None

    def _replace_sandbox(self) -> None:
        """Close the sandbox, whose time may be used up, and start another."""
        self.submission.__exit__()
        sandbox = tiers.choose(self.job["tier"])
        seconds = CALL_TIME_FRACTION * self.job["timeout"]
        fresh = subject.Subject(self.job["sources"], sandbox, seconds, self.job["modules"])
        self.submission = self.open.enter_context(fresh)

    def _ended(self, item: pytest.Item, raised: BaseException | None) -> None:
        self.raised = raised
        if not self.is_asking:
            super()._ended(item, raised)


def make_candidates(passed: Sequence[str], rng: np.random.Generator) -> list[Candidate]:
    """Return the candidates for all kinds and tasks, with tasks in random order."""
    has_second_search = len(passed) >= MIN_TASKS_FOR_SECOND_SEARCH
    searches = VERSIONS_PER_SEARCH if has_second_search else VERSIONS_PER_SEARCH[:1]
    pairs = [(kind, str(task)) for kind in KINDS for task in rng.permutation(passed)]
    return [
        Candidate(max_versions, kind, task) for max_versions in searches for kind, task in pairs
    ]


def least_asked(candidates: Sequence[Candidate], questions: Sequence[dict[str, Any]]) -> Candidate:
    """Return the candidate whose task, and then whose kind, was asked about least often.

    Candidates of the first search come before those of the second.
    """
    tasks = Counter(question["task"] for question in questions)
    kinds = Counter(question["kind"] for question in questions)
    return min(
        candidates,
        key=lambda candidate: (
            candidate.max_versions,
            tasks[candidate.task],
            kinds[candidate.kind],
        ),
    )


class QuestionGenerator:
    """Make questions on one task.

    Parameters
    ----------
    run : the run of the checks, whose sandbox runs the versions
    task : the task's id
    items : all checks of the run
    rng : draws versions, calls and options
    """

    def __init__(
        self, run: Examining, task: str, items: list[pytest.Item], rng: np.random.Generator
    ) -> None:
        self.run = run
        self.task = task
        self.rng = rng
        self.max_versions = VERSIONS_PER_SEARCH[0]
        self.items = [item for item in items if plugin.task_of(item) == task]
        self.source = run.job["sources"][task]
        calls = run.calls_of(task)
        self.calls = [calls[k] for k in rng.permutation(len(calls))]

    @property
    def own(self) -> changed.Version:
        """The student's own function."""
        return changed.Version(self.source, self.source)

    def question(self, kind: str, max_versions: int) -> dict[str, Any] | None:
        """Return a question as a page shows it, or None if the task has none of this kind."""
        self.max_versions = max_versions
        draft = self.draft(kind)
        right = int(self.rng.integers(OPTIONS_PER_QUESTION))
        if draft is None or not self.is_reproducible(draft):
            return None
        return {
            "kind": kind,
            "task": self.task,
            "right": right,
            "versions": [asdict(version) for version in draft.versions],
            **draft.shown,
        }

    def draft(self, kind: str) -> QuestionDraft | None:
        """Return four versions for a question of this kind, or None if there are too few."""
        if kind == "promise":
            return self.draft_promise()
        if kind == "line":
            return self.draft_line()
        if kind == "part":
            return self.draft_part()
        if kind == "value":
            return self.draft_value()
        return self.draft_picture()

    def is_reproducible(self, draft: QuestionDraft) -> bool:
        """Return whether each version gives its own value again, and none of the other three.

        The versions run in fresh processes in which `numpy.empty` returns other numbers. So a
        version whose answer depends on uninitialized memory is found out.
        """
        again = [
            draft.view(replace(version, source=version.source + changed.fill_empty_arrays()))
            for version in draft.versions
        ]
        same = [
            [a is not None and not draft.differ(a, value) for value in draft.values] for a in again
        ]
        return bool(np.array_equal(same, np.eye(OPTIONS_PER_QUESTION)))

    def draft_promise(self) -> QuestionDraft | None:
        """Ask which of four promises, in this order, a version breaks first."""
        versions: list[changed.Version] = []
        broken: list[set[str]] = []
        first: list[str] = []
        options: list[str] = []
        for version in self._draw_versions()[: self.max_versions // 2]:
            failed = self._broken_promises(version)
            if failed is None:
                continue
            if not failed and self._is_same(version.source):
                continue
            versions.append(version)
            broken.append(failed)
            order = rarest_first(broken)
            first = [first_broken(order, promises) for promises in broken]
            options = [promise for promise in [*order, NO_PROMISE] if promise in first]
            if len(options) >= OPTIONS_PER_QUESTION:
                break
            if len(versions) > MAX_VERSIONS_PER_PROMISE * len(options) + 1:
                break
        if len(options) < OPTIONS_PER_QUESTION:
            return None
        drawn = self.rng.choice(len(options), OPTIONS_PER_QUESTION, replace=False)
        chosen = [options[k] for k in sorted(drawn)]
        places = [first.index(promise) for promise in chosen]

        def view(version: changed.Version) -> str | None:
            failed = self._broken_promises(version)
            return None if failed is None else first_broken(chosen, failed)

        return QuestionDraft(
            versions=[versions[k] for k in places],
            values=chosen,
            view=view,
            differ=ne,
            shown={
                "texts": chosen,
                "broken": [sorted(broken[k]) for k in places],
                "call": self._format_call(self.calls[0]),
            },
        )

    def draft_line(self) -> QuestionDraft | None:
        """Ask which of three lines can be removed without changing any answer."""
        removable = changed.unused(self.source)
        if len(removable) < OPTIONS_PER_QUESTION - 1:
            return None
        for _ in range(MAX_LINE_DRAWS):
            drawn = self.rng.choice(list(removable), OPTIONS_PER_QUESTION - 1, replace=False)
            lines: list[int] = sorted(drawn.tolist())
            sources = [*(removable[k] for k in lines), self.source]
            texts = [[source.split("\n")[k - 1].strip() for k in lines] for source in sources]
            # if the lines read differently in one version, an option shows which version it is
            if texts.count(texts[0]) == OPTIONS_PER_QUESTION:
                break
        else:
            return None

        def view(version: changed.Version) -> int | None:
            superfluous = [k for k in lines if self._is_same(changed.without(version.source, k))]
            if len(superfluous) > 1 or not self._is_same(version.source):
                return None
            return superfluous[0] if superfluous else 0

        versions = [changed.Version(source, source) for source in sources]
        values = [*lines, 0]
        if [view(version) for version in versions] != values:
            return None
        return QuestionDraft(
            versions=versions,
            values=values,
            view=view,
            differ=ne,
            shown={"lines": lines, "texts": texts[0]},
        )

    def draft_part(self) -> QuestionDraft | None:
        """Ask in which part of a photograph, or of a curve, an answer changes most."""
        draft = self._draft_drawing(inputs.gaps, inputs.elsewhere)
        if draft is None:
            return None
        marks = [int(gaps.argmax()) for gaps in draft.values]
        return replace(draft, shown={**draft.shown, "marks": marks})

    def draft_picture(self) -> QuestionDraft | None:
        """Ask which of four images or curves a version returns."""
        draft = self._draft_drawing(inputs.levels, inputs.visible)
        if draft is None:
            return None
        figures = [inputs.figure(levels) for levels in draft.values]
        return replace(draft, shown={**draft.shown, "figures": figures})

    def draft_value(self) -> QuestionDraft | None:
        """Ask what a call returns that can be worked out by hand."""
        small = [inputs.small(call[:2]) for call in self.calls]
        small = [call for call in small if inputs.count(call) <= MAX_ARGUMENT_NUMBERS]
        for call in small[:MAX_CALLS]:
            view = partial(self._few_numbers, call)
            if view(self.own) is None:
                continue
            draft = self._find_four(view, inputs.apart)
            if draft is not None:
                texts = [inputs.format_answer(value) for value in draft.values]
                return replace(draft, shown={"call": self._format_call(call), "texts": texts})
        return None

    def _few_numbers(self, call: Any, version: changed.Version) -> Any:
        """Return a version's answer if it is a few numbers, else None."""
        answer = self._answer(version.source, call)
        return answer if inputs.is_readable(answer, MAX_ANSWER_NUMBERS) else None

    def _draft_drawing(
        self, see: Callable[[Any, Any], Any], differ: Callable[[Any, Any], Any]
    ) -> QuestionDraft | None:
        """Return four versions whose drawn answers differ; a photograph replaces images in the call."""
        photographs = self.run.job["photographs"]
        drawable = [call for call in self.calls if inputs.drawable_part(call[2]) is not None]
        for checked in drawable[:MAX_CALLS]:
            photograph = photographs[self.rng.integers(len(photographs))]
            call = inputs.put_photograph(checked[:2], np.array(photograph, np.uint8))
            own = inputs.drawable_part(self._answer(self.source, call))
            if own is None or own.min() == own.max():
                continue
            draft = self._find_four(partial(self._drawing, call, own, see), differ)
            if draft is None:
                continue
            shown = {
                "own": inputs.figure(inputs.levels(own, own)),
                "call": self._format_call(call),
                "scale": inputs.scale(own),
            }
            image = inputs.drawable_part(call[0])
            if image is not None and image.ndim > 1:
                shown["given"] = inputs.figure(inputs.levels(image, image))
            return replace(draft, shown=shown)
        return None

    def _drawing(
        self, call: Any, own: np.ndarray, see: Callable[[Any, Any], Any], version: changed.Version
    ) -> Any:
        """Return what a person sees of a version's answer beside the student's own, or None."""
        answer = inputs.drawable_part(self._answer(version.source, call))
        if answer is None or answer.shape != own.shape:
            return None
        return see(answer, own)

    def _find_four(self, view: View, differ: Callable[[Any, Any], Any]) -> QuestionDraft | None:
        """Return the first four drawn versions whose values differ from each other and from the own."""
        versions: list[changed.Version] = []
        values: list[Any] = []
        own = view(self.own)
        known = [] if own is None else [own]
        for version in self._draw_versions():
            value = view(version)
            if value is None or not all(differ(value, other) for other in known):
                continue
            versions.append(version)
            values.append(value)
            known.append(value)
            if len(values) == OPTIONS_PER_QUESTION:
                return QuestionDraft(
                    versions=versions, values=values, view=view, differ=differ, shown={}
                )
        return None

    def _format_call(self, call: Any) -> str:
        names = changed.parameters(self.source, self.task)
        return inputs.format_call(self.task, names, call[0], call[1], MAX_ARGUMENT_NUMBERS)

    def _draw_versions(self) -> list[changed.Version]:
        order = self.rng.permutation(len(self._all_versions))
        return [self._all_versions[k] for k in order[: self.max_versions]]

    @cached_property
    def _all_versions(self) -> list[changed.Version]:
        return changed.versions(self.source)

    def _answer(self, source: str, call: Any) -> Any:
        """Return the answer of a version, or None if there is none."""
        self.run.submission.fresh(**{self.task: source})
        return self._call(call)

    def _call(self, call: Any) -> Any:
        try:
            return getattr(self.run.submission, self.task)(*call[0], **call[1])
        except subject.NoAnswer:
            return None

    def _is_same(self, source: str) -> bool:
        """Return whether a version answers the smallest calls of the checks as the own function does."""
        calls = sorted(self.run.calls_of(self.task), key=lambda call: inputs.count(call[:2]))
        self.run.submission.fresh(**{self.task: source})
        return all(
            misconceptions.difference(self._call(call), call[2]) <= SAME_ANSWER
            for call in calls[:MAX_COMPARED_CALLS]
        )

    def _broken_promises(self, version: changed.Version) -> set[str] | None:
        """Return the promises that a version breaks, or None if the result depends on its speed."""
        self.run.submission.fresh(**{self.task: version.source})
        broken = set()
        for item in self.items:
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=None)
            raised = self.run.raised
            if isinstance(raised, subject.NoAnswer) and raised.kind not in ("raised", "refused"):
                return None
            if raised:
                broken.add(plugin.promise_of(item))
        return broken


def rarest_first(broken: Sequence[set[str]]) -> list[str]:
    """Return all broken promises, those that the fewest versions break first."""
    counts = Counter(promise for promises in broken for promise in promises)
    return sorted(counts, key=lambda promise: (counts[promise], promise))


def first_broken(order: Sequence[str], broken: set[str]) -> str:
    """Return the first promise of `order` that is broken, or `NO_PROMISE`."""
    return next((promise for promise in order if promise in broken), NO_PROMISE)
