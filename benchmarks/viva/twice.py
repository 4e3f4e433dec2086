"""Questions of `hdrlab viva` that are made in one process, and run once more in a sandbox.

The answers of the benchmark are trusted, and to make questions of them in a sandbox costs twenty
times as long.
"""

import hashlib
import math
import pickle
import resource
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from copy import deepcopy
from typing import Any

import numpy as np
import pytest

from hdrlab.course.checks import compare
from hdrlab.course.checks.subject import NoAnswer
from hdrlab.course.sandbox.inside import channel, worker
from hdrlab.course.viva import changed, examining

# seconds and bytes of a call in this process
PATIENCE = 1
MEMORY = 1 << 32
# Limits so large that no clock decides about a question: the time of a call in the sandbox, as a
# multiple of that of a check, and the seconds that the sandbox keeps for a question.
CALL_TIME_FACTOR = 3.0
MIN_SECONDS_LEFT = 60
QUESTIONS_PER_SITTING = examining.MAX_QUESTIONS

Question = dict[str, Any]


class Nowhere:
    """Where an answer goes that only must be one that the sandbox's channel takes."""

    def sendall(self, data: Any) -> None:
        """Take it, and forget it."""


class InProcess:
    """What a check asks, as `checks.subject.Subject`, of functions to trust that run in this process."""

    printed = ""
    seconds_left = math.inf

    def __init__(self, sources: dict[str, str]) -> None:
        self.texts = dict(sources)
        self.functions = dict[str, Any]()
        self.calls: list[Any] = []

    def fresh(self, **sources: str) -> None:
        """Know nothing of what was called before, with other texts of some tasks."""
        self.texts |= sources
        self.functions = {}

    def __getattr__(self, task: str) -> Any:
        def ask(*arguments: Any, **named: Any) -> Any:
            with in_time(), np.errstate(all="ignore"):
                if task not in self.functions:
                    scope: dict[str, Any] = {"__name__": task}
                    exec(compile(self.texts[task], task, "exec"), scope)
                    self.functions[task] = scope[task]
                answer = worker.collect_items(
                    self.functions[task](*deepcopy(arguments), **deepcopy(named))
                )
                channel.send(Nowhere(), "answer", answer)  # type: ignore[arg-type]  # or it is refused, as there
                return compare.plain(answer)

        return ask


@contextmanager
def in_time() -> Iterator[None]:
    """Raise NoAnswer for whatever goes wrong, or lasts too long."""

    def late(*_: object) -> None:
        raise TimeoutError

    signal.signal(signal.SIGALRM, late)
    signal.alarm(PATIENCE)
    try:
        yield
    except Exception as error:
        raise NoAnswer(
            str(error), "late" if isinstance(error, TimeoutError) else "raised"
        ) from None
    finally:
        signal.alarm(0)


class Twice(examining.QuestionGenerator):
    """A task that is asked about, all of whose four answers are computed once more, in the sandbox.

    What a version does is found once in either place, and remembered for the other sittings.
    """

    def question(self, kind: str, max_versions: int) -> Question | None:
        """Return the question; what is wrong with this very code is written down."""
        run: Any = self.run
        if max_versions > examining.VERSIONS_PER_SEARCH[0] and run.made >= QUESTIONS_PER_SITTING:
            return None  # the second search is made where there are fewer
        self.kind = kind
        question_found = None
        try:
            question_found = super().question(kind, max_versions)
        except Exception as error:
            run._write(question={"fault": f"{kind} of {self.task}: {error!r}"})
        run.made += question_found is not None
        return question_found

    def is_reproducible(self, draft: examining.QuestionDraft) -> bool:
        """Return what this process says of a question, and write down what the sandbox says."""
        if not super().is_reproducible(draft):
            return False
        run: Any = self.run
        run.submission, run.other = run.other, run.submission
        if run.submission.seconds_left < MIN_SECONDS_LEFT:
            examining.Examining._replace_sandbox(run)
        draft.shown["again"] = super().is_reproducible(draft)
        run.submission, run.other = run.other, run.submission
        return True

    def _find_four(self, view: Any, differ: Any) -> examining.QuestionDraft | None:
        digest = hashlib.sha256(pickle.dumps(view.args)).digest()

        def seen(version: changed.Version) -> Any:
            return self._known((self.kind, digest, version.source), lambda: view(version))

        return super()._find_four(seen, differ)

    def _is_same(self, source: str) -> bool:
        return bool(self._known(("same", source), lambda: super(Twice, self)._is_same(source)))

    def _broken_promises(self, version: changed.Version) -> set[str] | None:
        promises: set[str] | None = self._known(
            ("broken", version.source), lambda: super(Twice, self)._broken_promises(version)
        )
        return promises

    def _known(self, what: Any, find: Callable[[], Any]) -> Any:
        run: Any = self.run
        place = run.known.setdefault((type(run.submission), self.task), {})
        if what not in place:
            place[what] = find()
        return place[what]


class Examining(examining.Examining):
    """A run of the checks, after which questions are made in this process, and run again in the sandbox."""

    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        """Write down questions, and what became of them when they were run again."""
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        examining.QuestionGenerator = Twice  # type: ignore[misc]
        examining.CALL_TIME_FRACTION = CALL_TIME_FACTOR
        examining.MAX_QUESTIONS = int(self.job["most"])
        self.known = dict[Any, Any]()
        for seed in self.job["sittings"]:
            self.job["seed"] = seed
            self.made = 0
            super().pytest_sessionfinish(session)

    def _replace_sandbox(self) -> None:
        if isinstance(self.submission, InProcess):  # from the sitting before
            return
        super()._replace_sandbox()
        self.other, self.submission = self.submission, InProcess(self.job["sources"])  # type: ignore[assignment]
