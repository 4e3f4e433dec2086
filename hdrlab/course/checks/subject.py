"""The subject of a check: it looks like a module with the student's functions, which run elsewhere.

`subject.gsolve(Z, B, smoothness=10.0)` sends the arguments to a process in a sandbox, which calls the
student's function, and returns what came back: plain numbers, text, lists, tuples and arrays, built on this
side from raw bytes. Nothing of the student's is ever an object here, so no operator of theirs is called.
"""

import ast
import contextlib
import re
import secrets
import socket
import time
from collections.abc import Callable, Mapping
from types import TracebackType
from typing import Any, NamedTuple, NoReturn, Self

from hdrlab.course.checks import compare
from hdrlab.course.sandbox.inside import channel
from hdrlab.course.sandbox.running import Running, Sandbox

TIMEOUT = 10.0  # seconds of a call
OUTPUT = 1 << 16  # characters of a check that are kept of what was printed
REMEMBERED = 1 << 23  # bytes of a check's answers that are kept in `calls`
LOST = ("ended its process, and gave no answer", "sent what is no answer")  # or was killed by somebody else
CONTROLS = re.compile(r"\x1b\[[0-?]*[ -/]*[@-~]|[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")


class NoAnswer(AssertionError):
    """A call that was not answered, in plain words.

    Attributes
    ----------
    kind : "missing", "raised", "late", "died", "refused" or "damaged"
    error : the class of what was raised, such as "ValueError"
    line, text : where in the submission it was raised, and the line itself; None and "" where nobody knows
    """

    def __init__(
        self, says: str, kind: str, error: str = "", line: int | None = None, text: str = ""
    ) -> None:
        super().__init__(says)
        self.kind, self.error, self.line, self.text = kind, error, line, text


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
    names : mapping
        The name of each task's function in its source; the task's own, unless told.
    sandbox : Sandbox
        Where they run, from `hdrlab.course.sandbox.tiers.choose`.
    timeout : float
        Seconds that a call may take, with the first one's running of the source.

    Attributes
    ----------
    calls : list of Call
        What was called since `fresh`; answers are kept as long as they take 8 MB together.
    said : str
        What was printed since `fresh`, without control codes, its first 65536 characters.

    Examples
    --------
    >>> from hdrlab.course.sandbox import tiers
    >>> with Subject({"twice": "def twice(x): return 2 * x"}, {}, tiers.choose("practice")) as subject:
    ...     int(subject.twice(21))
    42
    """

    def __init__(
        self,
        sources: Mapping[str, str],
        names: Mapping[str, str],
        sandbox: Sandbox,
        timeout: float = TIMEOUT,
    ) -> None:
        self._sources, self._names, self._sandbox = dict(sources), dict(names), sandbox
        self._timeout = timeout
        self._running: Running | None = None
        self._link: socket.socket | None = None
        self.calls: list[Call] = []
        self.said = ""

    def __enter__(self) -> Self:
        self._running = Running(self._sandbox, modules_of(self._sources.values()))
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None
    ):
        self._drop()
        if self._running is not None:
            self._running.close()
            self._running = None

    def fresh(self) -> None:
        """Begin a new check: a new process, which knows nothing of the calls before."""
        self._drop()
        self.calls, self.said = [], ""

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
        order = {
            "task": task,
            "source": self._sources[task],
            "function": self._names.get(task, task),
            "args": args,
            "kwargs": kwargs,
        }
        kind, value = self._exchange(task, order)
        if kind == "answer":
            value = compare.plain(value)  # as the library's answers are, where the specification asks it
            if sum(_size(one.answer) for one in self.calls) + _size(value) <= REMEMBERED:
                self.calls[-1] = Call(task, args, kwargs, value)
            return value
        _explain(task, kind, value)

    def _exchange(self, task: str, order: dict[str, Any]) -> tuple[str, Any]:
        """Send an order and return the kind and value of its answer; without one, the process is dropped."""
        if self._running is None:
            raise RuntimeError("a Subject is used in a with statement")
        if self._link is None:
            self._link = self._running.check()
        call, deadline = secrets.randbits(60), time.monotonic() + self._timeout
        try:
            if _has_spoken(self._link):
                raise channel.Damaged("something before it was asked")
            self._link.settimeout(self._timeout)
            channel.send(self._link, "call", order, call)
            kind, echo, value = channel.receive(self._link, deadline)
            if echo != call:
                raise channel.Damaged("an answer to what was not asked")
            output, value = _checked(kind, value)
        except (OSError, EOFError, channel.Damaged) as error:
            self._drop()
            _no_answer(task, error, self._timeout)
        self.said = (self.said + readable(output))[:OUTPUT]
        return kind, value


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
    """Return (output, value) of an answer whose form is right, or raise Damaged."""
    if not (isinstance(value, tuple) and len(value) == 2 and isinstance(value[0], str)):
        raise channel.Damaged("an answer without its output")
    output, inner = value
    if kind == "refused" and isinstance(inner, str):
        return output, inner
    if kind == "raised" and isinstance(inner, dict) and set(inner) == {"error", "message", "line", "text"}:
        words = all(isinstance(inner[word], str) for word in ("error", "message", "text"))
        if words and (inner["line"] is None or isinstance(inner["line"], int)):
            return output, inner
    if kind == "answer":
        return output, inner
    raise channel.Damaged("an answer of no kind")


def _explain(task: str, kind: str, value: Any) -> NoReturn:
    """Raise the NoAnswer of a call that raised, or whose answer cannot travel."""
    if kind == "refused":
        raise NoAnswer(
            f"{task} answered with something that is no array: it contains {readable(value)[:300]}", "refused"
        )
    error, message, text = (readable(value[word])[:2000] for word in ("error", "message", "text"))
    where = f" (line {value['line']}: {text})" if value["line"] is not None else ""
    says = f"{task} raised {error}{': ' if message else ''}{message}{where}"
    raise NoAnswer(says, "raised", error, value["line"], text) from None


def _no_answer(task: str, error: Exception, timeout: float) -> NoReturn:
    """Raise the NoAnswer of a call whose process is late, gone, or wrote what is no answer."""
    if isinstance(error, TimeoutError):
        raise NoAnswer(f"{task} took longer than {timeout:g} s", "late") from None
    if isinstance(error, channel.Damaged):
        raise NoAnswer(f"{task} {LOST[1]}: {error}", "damaged") from None
    raise NoAnswer(f"{task} {LOST[0]}", "died") from None


def readable(text: str) -> str:
    """Return text without the codes that move a cursor, colour it, or turn its direction."""
    return CONTROLS.sub("", text)


def modules_of(sources: Any) -> list[str]:
    """Return the parts of numpy and scipy that some sources import, so that they are imported once.

    Examples
    --------
    >>> modules_of(["from scipy import ndimage", "import scipy.sparse.linalg as la, os", "not Python"])
    ['scipy', 'scipy.ndimage', 'scipy.sparse.linalg']
    """
    found = set()
    for source in sources:
        with contextlib.suppress(SyntaxError, ValueError, RecursionError, MemoryError):
            for node in ast.walk(ast.parse(source)):
                if isinstance(node, ast.Import):
                    found |= {alias.name for alias in node.names}
                elif isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
                    found |= {node.module} | {f"{node.module}.{alias.name}" for alias in node.names}
    return sorted(one for one in found if one.split(".")[0] in ("numpy", "scipy"))
