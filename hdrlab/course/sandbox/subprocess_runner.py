"""Run a function in its own process, so that a crash or a hang harms nothing else.

The parent writes pickled data to the child's standard input: first `sys.path`, then the limits, the
function and its argument. The child writes its answer to standard output: `+` and the returned
bytes, or `-` and the error in one line.

The child ends when its parent ends, even if the parent was killed, and so do processes that the
child has started.
"""

import contextlib
import os
import pickle
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TypeVar

import hdrlab
from hdrlab.course.sandbox.inside import system

Argument = TypeVar("Argument")

LIBRARY = Path(hdrlab.__file__).parent

POLL_SECONDS = 0.2
SIGKILL = 9  # sent by others, such as a system that is out of memory; Windows has no name for it
MAX_MESSAGE_LENGTH = 300
ANSWERED = b"+"
RAISED = b"-"


def import_path() -> str:
    """Return the PYTHONPATH with which a process imports this same hdrlab."""
    folders = [str(LIBRARY.parent), os.environ.get("PYTHONPATH")]
    return os.pathsep.join(folder for folder in folders if folder)


class ProcessFailed(RuntimeError):
    """Why a process gave no result, in one line.

    Attributes
    ----------
    is_own_fault : whether it exceeded a limit or crashed
    was_killed : whether something outside ended it
    """

    is_own_fault = False
    was_killed = False


def run(
    work: Callable[[Argument], bytes],
    argument: Argument,
    *,
    timeout: float,
    is_stopped: Callable[[], bool] = lambda: False,
    limits: Mapping[str, int] | None = None,
) -> bytes:
    """Return work(argument), computed in a new process.

    Parameters
    ----------
    work, argument : both can be pickled
    timeout : seconds after which the process is killed
    is_stopped : called several times a second; once it returns True, the process is killed
    limits : resource limits by their name in the module resource, such as {"CPU": 2}; ignored on
        systems without them

    Raises
    ------
    ProcessFailed
        If the work raised an error, or its process died, took too long or was stopped.
    """
    search_path = [folder for folder in sys.path if folder]
    order = pickle.dumps(search_path) + pickle.dumps((limits or {}, work, argument))
    command = [sys.executable, "-P", "-m", __name__, str(os.getpid())]
    with tempfile.TemporaryDirectory(prefix="hdrlab-piece-", ignore_cleanup_errors=True) as scratch:
        process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=os.environ | {"PYTHONPATH": import_path(), "TMPDIR": scratch},
        )
        with process:
            try:
                answer, errors = _communicate(process, order, timeout, is_stopped)
            finally:
                process.kill()
    if answer.startswith(ANSWERED):
        return answer[1:]
    raise _failure(answer, errors, process.returncode)


def _communicate(
    process: "subprocess.Popen[bytes]",
    order: bytes,
    timeout: float,
    is_stopped: Callable[[], bool],
) -> tuple[bytes, bytes]:
    """Send the order, and return what the process wrote to standard output and standard error."""
    deadline = time.monotonic() + timeout
    unsent: bytes | None = order
    while True:
        try:
            return process.communicate(unsent, timeout=POLL_SECONDS)
        except subprocess.TimeoutExpired:
            unsent = None  # communicate keeps what it has been given
        if is_stopped():
            raise ProcessFailed("it was stopped")
        if time.monotonic() > deadline:
            raise ProcessFailed("it took too long")


def _failure(answer: bytes, errors: bytes, exit_code: int) -> ProcessFailed:
    """Return the error that describes how a process without a result has ended."""
    lines = (answer[1:] or errors).decode(errors="replace").strip().splitlines()
    message = lines[-1] if lines else f"its process was ended ({exit_code})"
    failure = ProcessFailed(message[:MAX_MESSAGE_LENGTH])
    failure.was_killed = -exit_code in (signal.SIGTERM, SIGKILL)
    has_crashed = exit_code < 0 and not failure.was_killed
    failure.is_own_fault = has_crashed or answer.startswith(RAISED + b"MemoryError")
    return failure


def main(parent: str) -> None:
    """Read the order, do the work, and write the answer: the main function of the child."""
    parent_lives = system.die_with_parent(int(parent))
    if not parent_lives:
        return
    with os.fdopen(os.dup(1), "wb") as out:
        os.dup2(2, 1)  # what the work prints must not mix with the answer
        sys.path[:] = pickle.load(sys.stdin.buffer)
        limits, work, argument = pickle.load(sys.stdin.buffer)
        _set_limits(limits)
        try:
            out.write(ANSWERED + work(argument))
        except Exception as error:
            message = " ".join(f"{type(error).__name__}: {error}".split())
            out.write(RAISED + message.encode())


def _set_limits(limits: Mapping[str, int]) -> None:
    """Set resource limits for this process.

    The hard limit on CPU seconds is one higher: at the soft limit the system sends SIGXCPU, which
    differs from the SIGKILL that something outside may send.
    """
    for name, soft in limits.items():
        hard = soft + 1 if name == "CPU" else soft
        # Windows has no module resource, and not every system has each limit.
        with contextlib.suppress(AttributeError, ValueError, OSError):
            kind = getattr(system.resource, f"RLIMIT_{name}")
            system.resource.setrlimit(kind, (soft, hard))


if __name__ == "__main__":
    main(*sys.argv[1:])
