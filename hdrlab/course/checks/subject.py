"""The subject of a check: it looks like a module with the student's functions, which run elsewhere.

`subject.gsolve(Z, B, smoothness=10.0)` sends the arguments to a process in a sandbox, which calls
the student's function, and returns what came back: plain numbers, text, lists, tuples and arrays,
built on this side from raw bytes. Nothing of the student's is ever an object here, so no operator
of theirs is called.
"""

import contextlib
import math
import secrets
import socket
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple, NoReturn, Self

from hdrlab.course import sanitize
from hdrlab.course.checks import compare
from hdrlab.course.sandbox.inside import channel
from hdrlab.course.sandbox.running import Sandbox, SandboxSession

DEFAULT_CALL_TIMEOUT_SECONDS = 10.0
OUTPUT = 1 << 16  # characters of a check that are kept of what was printed
REMEMBERED = 1 << 23  # bytes of a check's answers that are kept in `calls`
# Limits as multiples of the time of one call: for one check, for all checks of a submission, and
# for the processor time of all calls of a submission.
CHECK_TIMEOUT_FACTOR = 3
SUBMISSION_TIMEOUT_FACTOR = 20
PROCESSOR_TIMEOUT_FACTOR = 4.0
# for a process to end after it has closed its connection
EXIT_TIMEOUT_SECONDS = 1.0
KILLED = (
    9  # the signal that ends a process from outside; no tier for credit lets a function send it
)


class NoAnswer(AssertionError):
    """A call that was not answered, in plain words.

    Attributes
    ----------
    kind : "missing", "raised", "late", "died", "refused", "damaged", or "killed" from outside
    """

    def __init__(self, says: str, kind: str) -> None:
        super().__init__(says)
        self.kind = kind


class Call(NamedTuple):
    """A call that was made: the task, its arguments, and the answer, None where there was none."""

    task: str
    args: tuple[Any, ...]
    kwargs: dict[str, Any]
    answer: Any


class Subject:
    """A student's functions, which are called in a sandbox.

    Parameters
    ----------
    sources : mapping
        The source text of each task, closed: with the imports and helpers that it needs.
    sandbox : Sandbox
        Where they run, from `hdrlab.course.sandbox.tiers.choose`.
    timeout : float
        Seconds that a call may take, with the first one's running of the source. All calls of a
        check may take three times as long, and all of a submission twenty times, of a processor
        four times.
    modules : sequence of str
        What the sources import of numpy and scipy.

    Attributes
    ----------
    calls : list of Call
        What was called since `fresh`; answers are kept as long as they take 8 MB together.
    said : str
        What was printed since `fresh`, without control codes, its first 65536 characters.

    Examples
    --------
    >>> from hdrlab.course.sandbox import tiers
    >>> with Subject({"twice": "def twice(x): return 2 * x"}, tiers.choose("practice")) as subject:
    ...     int(subject.twice(21))
    42
    """

    def __init__(
        self,
        sources: Mapping[str, str],
        sandbox: Sandbox,
        timeout: float = DEFAULT_CALL_TIMEOUT_SECONDS,
        modules: Sequence[str] = (),
    ) -> None:
        self._sources, self._sandbox = dict(sources), sandbox
        self._timeout, self._modules = timeout, modules
        self._left_of_check = CHECK_TIMEOUT_FACTOR * timeout
        self._left_of_all = SUBMISSION_TIMEOUT_FACTOR * timeout
        self._running: SandboxSession | None = None
        self._link: socket.socket | None = None
        self.calls: list[Call] = []
        self.said, self._kept = "", 0

    def __enter__(self) -> Self:
        self._running = SandboxSession(
            self._sandbox,
            self._modules,
            check_cpu_seconds=CHECK_TIMEOUT_FACTOR * self._timeout,
            total_cpu_seconds=PROCESSOR_TIMEOUT_FACTOR * self._timeout,
        )
        return self

    def __exit__(self, *error: object) -> None:
        self._drop()
        if self._running is not None:
            self._running.close()
            self._running = None

    def fresh(self, **sources: str) -> None:
        """Begin a new check, with other texts of some tasks: a process that knows nothing of those before."""
        self._drop()
        self._sources |= sources
        self.calls, self.said, self._kept = [], "", 0
        self._left_of_check = CHECK_TIMEOUT_FACTOR * self._timeout

    @property
    def left(self) -> float:
        """The seconds that are left for all calls, of a processor's time or of the clock's."""
        return min(self._left_of_all, self._running.cpu_seconds_left if self._running else math.inf)

    def _drop(self) -> None:
        """Let go of the check's process; it is ended before the next one begins, and with the sandbox."""
        if self._link is not None:
            self._link.close()
            self._link = None

    def __getattr__(self, task: str) -> Callable[..., Any]:
        if task.startswith("_") or task not in self._sources:
            raise AttributeError(f"the submission has no task {task}")

        def function(*args: Any, **kwargs: Any) -> Any:
            return self._call(task, args, kwargs)

        function.__name__ = task
        return function

    def _call(self, task: str, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        """Return the student's answer, or raise NoAnswer."""
        self.calls.append(Call(task, args, kwargs, None))
        order = {"task": task, "source": self._sources[task], "args": args, "kwargs": kwargs}
        kind, value = self._exchange(task, order)
        if kind == "answer":
            value = compare.plain(
                value
            )  # as the library's answers are, where the specification asks it
            if self._kept + (size := _size(value)) <= REMEMBERED:
                self._kept += size
                self.calls[-1] = Call(task, args, kwargs, value)
            return value
        _explain(task, kind, value)

    def _exchange(self, task: str, order: dict[str, Any]) -> tuple[str, Any]:
        """Send an order and return the kind and value of its answer; without one, the process is dropped."""
        if self._running is None:
            raise RuntimeError("a Subject is used in a with statement")
        if self._running.cpu_seconds_left <= 0:
            raise NoAnswer(f"{task}: {self._used_up()}", "late")
        if self._link is None:
            self._link = self._running.start_check()
        begun, call = time.monotonic(), secrets.randbits(60)
        patience = min(self._timeout, self._left_of_check, self._left_of_all)
        try:
            if patience <= 0:
                raise TimeoutError
            if _has_spoken(self._link):
                raise channel.ProtocolError("something before it was asked")
            self._link.settimeout(patience)
            channel.send(self._link, "call", order, call)
            kind, echo, value = channel.receive(self._link, begun + patience)
            if echo != call:
                raise channel.ProtocolError("an answer to what was not asked")
            output, value = _checked(kind, value)
        except (OSError, EOFError, channel.ProtocolError) as error:
            self._drop()
            self._spend(time.monotonic() - begun)
            self._explain_silence(task, error)
        self._spend(time.monotonic() - begun)
        self.said += sanitize.sanitize_text(output, OUTPUT - len(self.said))
        return kind, value

    def _spend(self, seconds: float) -> None:
        self._left_of_check -= seconds
        self._left_of_all -= seconds

    def _used_up(self) -> str:
        """Return which time is used up, in words; "" where there is some."""
        if self._running is not None and self._running.cpu_seconds_left <= 0:
            limit = PROCESSOR_TIMEOUT_FACTOR * self._timeout
            return f"the {limit:g} s of a processor for a whole submission are used up"
        if self._left_of_all <= 0:
            return f"the {SUBMISSION_TIMEOUT_FACTOR * self._timeout:g} s for a whole submission are used up"
        over = self._left_of_check <= 0
        return (
            f"the {CHECK_TIMEOUT_FACTOR * self._timeout:g} s for one check are used up"
            if over
            else ""
        )

    def _explain_silence(self, task: str, error: Exception) -> NoReturn:
        """Raise the NoAnswer of a call whose process is late, gone, or wrote what is no answer."""
        if isinstance(error, TimeoutError):
            over = self._used_up()
            says = f": {over}" if over else f" took longer than {self._timeout:g} s"
            raise NoAnswer(f"{task}{says}", "late") from None
        ended, used, granted = KILLED, 0.0, math.inf  # where the supervisor is gone, too
        with contextlib.suppress(OSError, EOFError, channel.ProtocolError):
            if self._running is not None:
                ended, used = self._running.clear_check(EXIT_TIMEOUT_SECONDS)
                granted = (
                    self._running.granted_cpu_seconds
                    if self._running.sandbox.can_fork
                    else math.inf
                )
        if used >= granted - 0.5 and ended == KILLED:
            raise NoAnswer(f"{task} took longer than {granted} s of a processor", "late") from None
        if isinstance(error, channel.ProtocolError):
            kind = "killed" if ended == KILLED else "damaged"
            raise NoAnswer(f"{task} sent what is no answer: {error}", kind) from None
        kind = "killed" if ended == KILLED else "died"
        raise NoAnswer(f"{task} ended its process, and gave no answer", kind) from None


def _size(answer: Any) -> int:
    """Return the bytes of the arrays in an answer, about."""
    if isinstance(answer, tuple | list):
        return sum(_size(one) for one in answer)
    return getattr(answer, "nbytes", 0)


def _has_spoken(link: socket.socket) -> bool:
    """Return whether something came on the link that nobody asked for."""
    link.setblocking(False)
    with contextlib.suppress(BlockingIOError):
        return bool(link.recv(1))  # nothing at all means that it has closed: sending will tell
    return False


def _checked(kind: str, value: Any) -> tuple[str, Any]:
    """Return (output, value) of an answer whose form is right, or raise ProtocolError."""
    if not (isinstance(value, tuple) and len(value) == 2 and isinstance(value[0], str)):
        raise channel.ProtocolError("an answer without its output")
    right = kind == "answer"
    match value[1]:
        case str():
            right |= kind == "refused"
        case {"error": str(), "message": str(), "text": str(), "line": int() | None, **rest}:
            right |= kind == "raised" and not rest
    if not right:
        raise channel.ProtocolError("an answer of no kind")
    return value


def _explain(task: str, kind: str, value: Any) -> NoReturn:
    """Raise the NoAnswer of a call that raised, or whose answer cannot travel."""
    if kind == "refused":
        content = sanitize.sanitize_text(value, 300)
        says = f"{task} answered with something that is no array: it contains {content}"
        raise NoAnswer(says, "refused")
    error, message, text = (
        sanitize.sanitize_text(value[word], 2000) for word in ("error", "message", "text")
    )
    where = f" (line {value['line']}: {text})" if value["line"] is not None else ""
    raise NoAnswer(
        f"{task} raised {error}{': ' if message else ''}{message}{where}", "raised"
    ) from None
