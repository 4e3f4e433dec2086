"""Call a student's functions in a sandbox, as if they were functions of a module.

`subject.gsolve(Z, B, smoothness=10.0)` sends the arguments to a process in a sandbox, which calls
the student's function, and returns the answer: plain numbers, text, lists, tuples and arrays that
are built in this process from raw bytes. No object of the student's code ever exists in this
process, so no operator of such an object is ever called.
"""

import secrets
import socket
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, NoReturn, Self

from hdrlab.course import sanitize
from hdrlab.course.checks import compare
from hdrlab.course.limits import CALL_TIMEOUT_SECONDS
from hdrlab.course.sandbox import in_process
from hdrlab.course.sandbox.inside import channel
from hdrlab.course.sandbox.session import Sandbox, SandboxSession

# limits as multiples of the time of one call: for one check, for all checks of a submission, and
# for the processor time of all calls of a submission
CHECK_TIMEOUT_FACTOR = 3
SUBMISSION_TIMEOUT_FACTOR = 20
PROCESSOR_TIMEOUT_FACTOR = 4.0
# for a process to end after it has closed its connection
EXIT_TIMEOUT_SECONDS = 1.0
# how far below its limit the measured processor time of a process that reached the limit may be
CPU_LIMIT_TOLERANCE_SECONDS = 0.5
# limits of what is kept of one check: what it printed, and its answers in `Subject.calls`
MAX_PRINTED_CHARACTERS = 2**16
MAX_KEPT_ANSWER_BYTES = 8 * 2**20
# limits of texts in a message
MAX_REFUSED_CONTENT_CHARACTERS = 300
MAX_ERROR_CHARACTERS = 2000
# the number of the signal, which Windows' module `signal` lacks. Only something outside of the
# sandbox can send it: no tier for credit lets a function send signals.
SIGKILL = 9
CALL_NUMBER_BITS = 60


# a sandbox of a process, or its stand-in where there is none
Session = SandboxSession | in_process.InProcessSession
Link = socket.socket | in_process.Link


class NoAnswer(AssertionError):
    """Raised if a call was not answered; the message says why.

    Attributes
    ----------
    kind : str
        "missing": the task was not handed in. "raised": the function raised an exception. "late":
        the time is used up. "died": its process ended. "refused": the answer is not made of plain
        values and arrays. "damaged": what came is not an answer. "killed": something outside of the
        sandbox ended the process.
    """

    def __init__(self, message: str, kind: str) -> None:
        super().__init__(message)
        self.kind = kind


class Call(NamedTuple):
    """A call of a task's function; the answer is None if there was none, or it was not kept."""

    task: str
    args: tuple[Any, ...]
    kwargs: dict[str, Any]
    answer: Any


@dataclass(frozen=True, kw_only=True)
class Answer:
    """What came back for a call.

    Attributes
    ----------
    kind : "answer", "raised" or "refused"
    value : the answer, a description of the exception, or what the refused answer contains
    printed : what the function printed
    """

    kind: str
    value: Any
    printed: str


class Subject:
    """A student's functions, which are called in a sandbox.

    Parameters
    ----------
    sources : mapping
        The complete source of each task, with the imports and helpers that it needs.
    sandbox : Sandbox
        Where they run, from `hdrlab.course.sandbox.tiers.choose`.
    timeout : float
        Seconds that a call may take. The first call of a check also runs the source. All calls of a
        check together may take three times as long, and all calls of a submission twenty times as
        long, with four times as much processor time.
    modules : sequence of str
        Modules of numpy and scipy that the sources import.

    Attributes
    ----------
    calls : list of Call
        The calls since `fresh`. Answers are kept as long as they take 8 MB together.
    printed : str
        What was printed since `fresh`: its first 65536 characters, without control codes.

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
        timeout: float = CALL_TIMEOUT_SECONDS,
        modules: Sequence[str] = (),
    ) -> None:
        self._sources = dict(sources)
        self._sandbox = sandbox
        self._timeout = timeout
        self._modules = modules
        self._check_seconds_left = CHECK_TIMEOUT_FACTOR * timeout
        self._submission_seconds_left = SUBMISSION_TIMEOUT_FACTOR * timeout
        self._session: Session | None = None
        self._link: Link | None = None
        self._kept_answer_bytes = 0
        self.calls: list[Call] = []
        self.printed = ""

    def __enter__(self) -> Self:
        if isinstance(self._sandbox, in_process.InProcessSandbox):
            self._session = in_process.InProcessSession(self._sandbox, self._modules)
            return self
        self._session = SandboxSession(
            self._sandbox,
            self._modules,
            check_cpu_seconds=CHECK_TIMEOUT_FACTOR * self._timeout,
            total_cpu_seconds=PROCESSOR_TIMEOUT_FACTOR * self._timeout,
        )
        return self

    def __exit__(self, *error: object) -> None:
        self._close_link()
        if self._session is not None:
            self._session.close()
            self._session = None

    def fresh(self, **sources: str) -> None:
        """Begin a new check in a new process, which knows nothing of the previous one.

        Parameters
        ----------
        sources : str
            Sources that replace those of some tasks from now on.
        """
        self._close_link()
        self._sources |= sources
        self._kept_answer_bytes = 0
        self.calls = []
        self.printed = ""
        self._check_seconds_left = CHECK_TIMEOUT_FACTOR * self._timeout

    def limit_check(self, seconds: float) -> None:
        """Let the further calls until `fresh` take at most so many seconds together."""
        self._check_seconds_left = min(self._check_seconds_left, seconds)

    @property
    def seconds_left(self) -> float:
        """Seconds that are left for all calls: processor time or clock time, whichever is less."""
        if self._session is None:
            return self._submission_seconds_left
        return min(self._submission_seconds_left, self._session.cpu_seconds_left)

    def _close_link(self) -> None:
        """Close the connection to the check's process; the sandbox session ends the process later."""
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
        answer = self._exchange(task, args, kwargs)
        if answer.kind != "answer":
            _raise_no_answer(task, answer)
        # in the same form as the library's answers, which the specification expects
        value = compare.plain(answer.value)
        size = _count_bytes(value)
        if self._kept_answer_bytes + size <= MAX_KEPT_ANSWER_BYTES:
            self._kept_answer_bytes += size
            self.calls[-1] = Call(task, args, kwargs, value)
        return value

    def _exchange(self, task: str, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Answer:
        """Call a task's function in the check's process, and return what comes back.

        If nothing valid comes back, this closes the connection to the process and raises NoAnswer.
        """
        if self._session is None:
            raise RuntimeError("a Subject is used in a with statement")
        if self._session.cpu_seconds_left <= 0:
            raise NoAnswer(f"{task}: {self._used_up_time()}", "late")
        if self._link is None:
            self._link = self._session.start_check()
        order = {"task": task, "source": self._sources[task], "args": args, "kwargs": kwargs}
        started = time.monotonic()
        try:
            answer = self._send_and_receive(self._link, order, started)
        except (OSError, EOFError, channel.ProtocolError) as error:
            self._close_link()
            self._spend(time.monotonic() - started)
            self._raise_silence(task, error, self._session)
        self._spend(time.monotonic() - started)
        room = MAX_PRINTED_CHARACTERS - len(self.printed)
        self.printed += sanitize.sanitize_text(answer.printed, room)
        return answer

    def _send_and_receive(self, link: Link, order: dict[str, Any], started: float) -> Answer:
        """Send an order over a link, and return the answer that comes before the time is used up."""
        patience = min(self._timeout, self._check_seconds_left, self._submission_seconds_left)
        if patience <= 0:
            raise TimeoutError
        if _has_unread_data(link):
            raise channel.ProtocolError("data came before the call")
        # a random number, so that the student's code cannot write an answer to a later call
        call_number = secrets.randbits(CALL_NUMBER_BITS)
        link.settimeout(patience)
        channel.send(link, "call", order, call_number)
        kind, answered_call, value = channel.receive(link, started + patience)
        if answered_call != call_number:
            raise channel.ProtocolError("it belongs to another call")
        return _parse_answer(kind, value)

    def _spend(self, seconds: float) -> None:
        """Subtract seconds from the time of the check and of the submission."""
        self._check_seconds_left -= seconds
        self._submission_seconds_left -= seconds

    def _used_up_time(self) -> str:
        """Return a clause that says which time is used up, or "" if there is time left."""
        if self._session is not None and self._session.cpu_seconds_left <= 0:
            limit = PROCESSOR_TIMEOUT_FACTOR * self._timeout
            return f"the {limit:g} s of processor time for a whole submission are used up"
        if self._submission_seconds_left <= 0:
            limit = SUBMISSION_TIMEOUT_FACTOR * self._timeout
            return f"the {limit:g} s for a whole submission are used up"
        if self._check_seconds_left <= 0:
            limit = CHECK_TIMEOUT_FACTOR * self._timeout
            return f"the {limit:g} s for one check are used up"
        return ""

    def _raise_silence(self, task: str, error: Exception, session: Session) -> NoReturn:
        """Raise the NoAnswer of a call whose process is late, is gone, or sent an invalid answer."""
        if isinstance(error, TimeoutError):
            used_up = self._used_up_time()
            if used_up:
                raise NoAnswer(f"{task}: {used_up}", "late") from None
            raise NoAnswer(f"{task} took longer than {self._timeout:g} s", "late") from None
        granted = session.granted_cpu_seconds
        try:
            signal, cpu_seconds = session.clear_check(EXIT_TIMEOUT_SECONDS)
        except (OSError, EOFError, channel.ProtocolError):
            # the supervisor was killed, too
            was_killed = True
            reached_limit = False
        else:
            was_killed = signal == SIGKILL
            reached_limit = cpu_seconds >= granted - CPU_LIMIT_TOLERANCE_SECONDS
        # the system kills a process that reaches its limit of processor time
        if was_killed and reached_limit and session.sandbox.can_fork:
            message = f"{task} took longer than {granted} s of processor time"
            raise NoAnswer(message, "late") from None
        if isinstance(error, channel.ProtocolError):
            message = f"{task} sent an invalid answer: {error}"
            raise NoAnswer(message, "killed" if was_killed else "damaged") from None
        message = f"{task} ended its process, and gave no answer"
        raise NoAnswer(message, "killed" if was_killed else "died") from None


def _count_bytes(answer: Any) -> int:
    """Return the bytes of the arrays in an answer."""
    if isinstance(answer, tuple | list):
        return sum(_count_bytes(item) for item in answer)
    return getattr(answer, "nbytes", 0)


def _has_unread_data(link: Link) -> bool:
    """Return whether data arrived on a link; if so, this takes a byte of it."""
    link.setblocking(False)
    try:
        # b"" means that the other end has closed, which sending will tell
        return link.recv(1) != b""
    except BlockingIOError:
        return False


def _parse_answer(kind: str, content: Any) -> Answer:
    """Return an answer whose form is right, or raise ProtocolError.

    Parameters
    ----------
    kind : str
        "answer", "raised" or "refused", if the form is right.
    content : tuple
        What was printed, and the value, if the form is right.
    """
    if not (isinstance(content, tuple) and len(content) == 2 and isinstance(content[0], str)):
        raise channel.ProtocolError("it comes without its output")
    printed, value = content
    if not _has_form(kind, value):
        raise channel.ProtocolError("it has the wrong form")
    return Answer(kind=kind, value=value, printed=printed)


def _has_form(kind: str, value: Any) -> bool:
    """Return whether the value of an answer has the form of its kind."""
    match kind, value:
        case "answer", _:
            return True
        case "refused", str():
            return True
        case "raised", {"error": str(), "message": str(), "text": str(), "line": int() | None}:
            return len(value) == 4
    return False


def _raise_no_answer(task: str, answer: Answer) -> NoReturn:
    """Raise the NoAnswer of a call that raised an exception, or whose answer was refused."""
    if answer.kind == "refused":
        content = sanitize.sanitize_text(answer.value, MAX_REFUSED_CONTENT_CHARACTERS)
        message = f"{task} returned something that is not an array: it contains {content}"
        raise NoAnswer(message, "refused")
    error = sanitize.sanitize_text(answer.value["error"], MAX_ERROR_CHARACTERS)
    error_message = sanitize.sanitize_text(answer.value["message"], MAX_ERROR_CHARACTERS)
    line = answer.value["line"]
    message = f"{task} raised {error}"
    if error_message:
        message += f": {error_message}"
    if line is not None:
        text = sanitize.sanitize_text(answer.value["text"], MAX_ERROR_CHARACTERS)
        message += f" (line {line}: {text})"
    raise NoAnswer(message, "raised") from None
