"""One piece of work in a process of its own, so that whatever becomes of that process happens to no other.

order   on the standard input: where modules are found, then limits, work and piece, pickled by this program
answer  on the standard output: a sign, + or -, and the result's bytes, or why there are none

The process ends with the one that started it, however that ended, and so do those that it starts
itself.
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
from typing import Any

from hdrlab.course.checks.running import import_path
from hdrlab.course.sandbox.inside import system

TICK = 0.2  # seconds between two looks at whether it is to be ended
KILLED = 9  # the signal of those outside, such as a system that is out of memory
LAST = 300  # characters of why it failed


class Failed(RuntimeError):
    """Why a piece of work has no result, in a line.

    `own` where it reached a limit, or crashed by itself; `killed` where somebody else has ended it.
    """

    own = killed = False


def run(
    work: Callable[[Any], bytes],
    piece: Any,
    *,
    patience: float,
    stopped: Callable[[], bool] = lambda: False,
    limits: Mapping[str, int] | None = None,
) -> bytes:
    """Return work(piece), computed in a process of its own.

    Parameters
    ----------
    work, piece : both can be pickled
    patience : seconds that it may take
    stopped : asked again and again; where it says so, the process is ended
    limits : of the process, named as in the module resource, where the system has them

    Raises
    ------
    Failed
        Where the work raised an error, its process died, took too long, or was stopped.
    """
    order = pickle.dumps([one for one in sys.path if one]) + pickle.dumps(
        (limits or {}, work, piece)
    )
    with tempfile.TemporaryDirectory(prefix="hdrlab-piece-", ignore_cleanup_errors=True) as scratch:
        process = subprocess.Popen(
            [
                sys.executable,
                "-P",
                "-m",
                "hdrlab.course.classroom.executors.alone",
                str(os.getpid()),
            ],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=os.environ | {"PYTHONPATH": import_path(), "TMPDIR": scratch},
        )
        with process:
            try:
                answer, said = _answer(process, order, time.monotonic() + patience, stopped)
            finally:
                process.kill()
    if answer[:1] == b"+":
        return answer[1:]
    lines = (answer[1:] or said).decode(errors="replace").strip().splitlines()
    failed = Failed(
        (lines[-1] if lines else f"its process was ended ({process.returncode})")[:LAST]
    )
    code = process.returncode
    failed.killed = -code in (signal.SIGTERM, KILLED)
    failed.own = answer[:12] == b"-MemoryError" or (code < 0 and not failed.killed)
    raise failed


def _answer(
    process: "subprocess.Popen[bytes]", order: bytes, until: float, stopped: Callable[[], bool]
) -> tuple[bytes, bytes]:
    """Return what a process answered and what it said besides, or raise Failed when it is to be ended."""
    given: bytes | None = order
    while True:
        try:
            return process.communicate(given, timeout=TICK)
        except subprocess.TimeoutExpired:
            given = None  # it has been told
        if stopped():
            raise Failed("it was stopped")
        if time.monotonic() > until:
            raise Failed("it took too long")


def main(parent: str) -> None:
    """Read the order, do the work, and answer: the whole life of this process."""
    if not system.end_with(int(parent)):  # it has died meanwhile
        return
    with os.fdopen(os.dup(1), "wb") as out:
        os.dup2(2, 1)  # what anything prints is no part of the answer
        sys.path[:] = pickle.load(sys.stdin.buffer)
        limits, work, piece = pickle.load(sys.stdin.buffer)
        _limit(limits)
        try:
            out.write(b"+" + work(piece))
        except Exception as error:
            out.write(b"-" + " ".join(f"{type(error).__name__}: {error}".split()).encode())


def _limit(limits: Mapping[str, int]) -> None:
    """Limit this process; one that has used its seconds is ended by a signal of its own, not by SIGKILL."""
    for name, most in limits.items():
        with contextlib.suppress(
            AttributeError, ValueError, OSError
        ):  # Windows has no module resource
            which = getattr(system.resource, f"RLIMIT_{name}")
            system.resource.setrlimit(which, (most, most + (name == "CPU")))


if __name__ == "__main__":
    main(*sys.argv[1:])
