"""The in-process tier: a student's functions run in this very interpreter, without a process.

It is for a page in a browser, where no process can be started. Everything that travels is still
packed and unpacked by `channel`, so that answers which are no plain values or arrays are refused as
in the other tiers, and a function cannot change the arrays of the grader. Scores from this tier
never count: DOES_NOT_STOP lists what it does not stop.
"""

import builtins
import contextlib
import importlib
import linecache
import math
import sys
import threading
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from socket import socket
from types import FrameType
from typing import Any

import numpy as np

from hdrlab.course.sandbox import session
from hdrlab.course.sandbox.inside import channel, worker

TIER = "in-process"
IS_BROWSER = sys.platform == "emscripten"
DOES_NOT_STOP = (
    "an endless loop in compiled code, which only a restart of the kernel ends",
    "filling the memory, and ending the whole program",
    "changing a module, such as numpy, for everything that runs afterwards",
    "reading any file",
)
# packages that the other tiers have beside Python's own modules
ALLOWED_PACKAGES = ("numpy", "scipy")
# warnings that Python shows for a student's module when it runs in a process of its own
SILENT_WARNINGS: tuple[type[Warning], ...] = (
    DeprecationWarning,
    PendingDeprecationWarning,
    ImportWarning,
    ResourceWarning,
)
# Python 3.11 does not report `while True: pass` line by line
TRACES_INSTRUCTIONS = sys.version_info < (3, 12)
# how CPython for WebAssembly refuses a process
NO_PROCESSES = "does not support processes"

# the thread in which a student's function runs at this moment, None if none runs
_busy_thread: int | None = None
_has_audit_hook = False


class TimeIsUp(BaseException):
    """Raised inside a student's function when its time is up; `except Exception` does not catch it."""


class ByteQueue:
    """Bytes that are written at one end and read at the other, in order, as through a socket."""

    def __init__(self) -> None:
        self._data = bytearray()

    def __len__(self) -> int:
        return len(self._data)

    def sendall(self, data: Any) -> None:
        """Append bytes."""
        self._data += data

    def recv_into(self, buffer: memoryview) -> int:
        """Move as many bytes as there are, and as fit, into a buffer; return how many."""
        count = min(len(buffer), len(self._data))
        buffer[:count] = self._data[:count]
        del self._data[:count]
        return count

    def settimeout(self, seconds: float | None) -> None:
        """Do nothing: reading never waits."""


@dataclass
class CheckState:
    """What a student's functions leave behind during one check.

    Attributes
    ----------
    namespaces : what each source that was run defines
    random_state : of numpy's global random generator, None before the first call
    modules : names that the sources have in sys.modules, each with what was there before
    """

    namespaces: dict[str, dict[str, Any]] = field(default_factory=dict)
    random_state: Any = None
    modules: dict[str, Any] = field(default_factory=dict)


class Link:
    """The connection of one check: a call that was sent is answered when the answer is read.

    It has the methods of a socket that `Subject` and `channel` use.
    """

    def __init__(self) -> None:
        self._orders = ByteQueue()
        self._answers = ByteQueue()
        self._state = CheckState()
        self._timeout: float | None = None

    def sendall(self, data: Any) -> None:
        """Send a part of a call."""
        self._orders.sendall(data)

    def recv_into(self, buffer: memoryview) -> int:
        """Read a part of the answer, for which the student's function is called first.

        Raises
        ------
        TimeoutError
            If the function takes longer than the timeout.
        """
        if not len(self._answers) and len(self._orders):
            self._answer_call()
        return self._answers.recv_into(buffer)

    def recv(self, size: int) -> bytes:
        """Raise BlockingIOError: no answer comes before its call."""
        raise BlockingIOError

    def settimeout(self, seconds: float | None) -> None:
        """Set how long a call may take."""
        self._timeout = seconds

    def setblocking(self, flag: bool) -> None:
        """Do nothing: reading never waits."""

    def close(self) -> None:
        """Forget what the check defined."""
        for name, before in self._state.modules.items():
            linecache.cache.pop(f"<{name}>", None)
            if before is None:
                sys.modules.pop(name, None)
            else:
                sys.modules[name] = before
        self._state = CheckState()

    def _answer_call(self) -> None:
        """Call the student's function, and write its answer."""
        _, call_number, order = channel.receive(self._orders)
        printed = worker.PrintedText()
        kind, value = _run_call(order, self._state, printed, self._timeout)
        output = printed.take()
        try:
            channel.send(self._answers, kind, (output, value), call_number)
        except channel.UnsupportedValue as error:
            reason = str(error)[: worker.MAX_MESSAGE_CHARACTERS]
            channel.send(self._answers, "refused", (output, reason), call_number)


class InProcessSandbox(session.Sandbox):
    """The in-process tier, for which `Subject` opens an InProcessSession."""


class InProcessSession:
    """What `SandboxSession` is to the other tiers; nothing has to be started or ended."""

    granted_cpu_seconds = 0
    cpu_seconds_left = math.inf

    def __init__(self, sandbox: session.Sandbox, modules: Sequence[str] = ()) -> None:
        self.sandbox = sandbox
        # before the first call, whose time they would take: seconds in a browser
        for name in modules:
            # if a module is missing, the submission fails where it imports it
            with contextlib.suppress(ImportError):
                importlib.import_module(name)

    def start_check(self) -> Link:
        """Return the link of a new check, which knows nothing of the previous one."""
        return Link()

    def clear_check(self, patience: float = 0.0) -> tuple[int, float]:
        """Return (0, 0.0): no signal ended the check, and no processor time was measured."""
        return 0, 0.0

    def close(self) -> None:
        """Do nothing."""


def sandbox() -> session.Sandbox:
    """Return the in-process tier, which every machine can run."""
    return InProcessSandbox(tier=TIER, credit=False, launch=_refuse_launch, can_fork=False)


def _refuse_launch(control: socket) -> session.SandboxProcess:
    """Raise Unavailable: this tier has no process that could be launched."""
    raise session.Unavailable("the in-process tier starts no process")


def _run_call(
    order: dict[str, Any], state: CheckState, printed: worker.PrintedText, timeout: float | None
) -> tuple[str, Any]:
    """Call a student's function as an order says, and return the kind and the value of its answer.

    Raises
    ------
    TimeoutError
        If the function takes longer than `timeout` seconds.
    """
    name = order["task"]
    if name not in state.modules:
        state.modules[name] = sys.modules.get(name)
    try:
        with (
            contextlib.redirect_stdout(printed),
            contextlib.redirect_stderr(printed),
            _own_random_state(state),
            _own_warnings(printed),
            np.errstate(),
            _forbidding(),
            _time_limit(timeout),
        ):
            _prepare_imports(order, state.namespaces)
            return "answer", worker.call_function(order, state.namespaces)
    except TimeIsUp:
        raise TimeoutError from None
    except KeyboardInterrupt:  # the reader stops the check
        raise
    except BaseException as error:
        return "raised", worker.describe_error(_in_words(error))


def _in_words(error: BaseException) -> BaseException:
    """Return an error, in the words of the other tiers where WebAssembly has its own."""
    if IS_BROWSER and isinstance(error, OSError) and NO_PROCESSES in str(error):
        action = worker.FORBIDDEN_ACTIONS["subprocess.Popen"]
        translated = PermissionError(worker.FORBIDDEN_MESSAGE.format(action))
        return translated.with_traceback(error.__traceback__)
    return error


def _prepare_imports(order: dict[str, Any], namespaces: dict[str, dict[str, Any]]) -> None:
    """Run the source of an order, if it is new, so that its code can import what a sandbox has."""
    source = order["source"]
    if source in namespaces:
        return
    own_builtins = vars(builtins) | {"__import__": _import_allowed}
    namespaces[source] = worker.run_source(source, order["task"], own_builtins)


def _import_allowed(name: str, *details: Any, **more: Any) -> Any:
    """Import a module of Python, numpy or scipy for a student's code; refuse all others."""
    root = name.partition(".")[0]
    if root not in ALLOWED_PACKAGES and root not in sys.stdlib_module_names:
        raise ModuleNotFoundError(f"No module named {root!r}", name=root)
    return builtins.__import__(name, *details, **more)


@contextlib.contextmanager
def _own_random_state(state: CheckState) -> Iterator[None]:
    """Give the code numpy's global random generator as a new process has it, seeded with 0."""
    outer = np.random.get_state()  # noqa: NPY002
    if state.random_state is None:
        np.random.seed(0)  # noqa: NPY002
    else:
        np.random.set_state(state.random_state)  # noqa: NPY002
    try:
        yield
    finally:
        state.random_state = np.random.get_state()  # noqa: NPY002
        np.random.set_state(outer)  # noqa: NPY002


@contextlib.contextmanager
def _own_warnings(printed: worker.PrintedText) -> Iterator[None]:
    """Print the warnings that Python prints by default, whatever is set for the interpreter."""

    def print_warning(
        message: Warning | str,
        category: type[Warning],
        filename: str,
        lineno: int,
        file: Any = None,
        line: str | None = None,
    ) -> None:
        printed.write(warnings.formatwarning(message, category, filename, lineno, line))

    with warnings.catch_warnings():
        warnings.resetwarnings()
        for category in SILENT_WARNINGS:
            warnings.simplefilter("ignore", category)
        warnings.showwarning = print_warning
        yield


@contextlib.contextmanager
def _forbidding() -> Iterator[None]:
    """Forbid this thread what no check may do, with the words of `worker.forbid_actions`."""
    global _busy_thread, _has_audit_hook
    if not _has_audit_hook:
        sys.addaudithook(_forbid_in_busy_thread)  # cannot be removed again
        _has_audit_hook = True
    before = _busy_thread
    _busy_thread = threading.get_ident()
    try:
        yield
    finally:
        _busy_thread = before


def _forbid_in_busy_thread(event: str, arguments: tuple[Any, ...]) -> None:
    """Refuse what a check may not do, if the thread runs a student's function: an audit hook."""
    if _busy_thread is not None and _busy_thread == threading.get_ident():
        worker.forbid_actions(event, arguments)


@contextlib.contextmanager
def _time_limit(seconds: float | None) -> Iterator[None]:
    """Raise TimeIsUp in a student's Python code once the seconds are over.

    The clock is read at each line of a submission, whose file has a name such as <gsolve>. So an
    endless loop in Python ends; compiled code that never returns does not.
    """
    if seconds is None:
        yield
        return
    deadline = time.monotonic() + seconds
    outer = sys.gettrace()

    def trace(frame: FrameType, event: str, argument: Any) -> Callable[..., Any] | None:
        if not frame.f_code.co_filename.startswith("<"):
            return None
        frame.f_trace_opcodes = TRACES_INSTRUCTIONS
        if time.monotonic() > deadline:
            raise TimeIsUp
        return trace

    sys.settrace(trace)
    try:
        yield
    finally:
        sys.settrace(outer)
