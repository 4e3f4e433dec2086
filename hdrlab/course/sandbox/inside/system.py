"""What one operating system has and another lacks: no other module imports what POSIX alone has.

Like channel.py it goes into the sandbox, where hdrlab is not, and needs the standard library alone.
"""

import contextlib
import ctypes
import importlib
import os
import signal
import socket
import sys
import time
from collections.abc import Callable
from typing import Any

LINUX = sys.platform == "linux"
DIE_WITH_PARENT, ADOPT, SECCOMP, NO_NEW_PRIVILEGES = 1, 36, 22, 38  # prctl's numbers


def _optional(name: str) -> Any:
    """Return a module of the standard library, or None where this system has none of that name."""
    with contextlib.suppress(ImportError):
        return importlib.import_module(name)
    return None


resource = _optional("resource")


def prctl(number: int, *values: Any) -> None:
    """Ask Linux for a property of this process; other systems are left alone."""
    if LINUX:
        libc = ctypes.CDLL(None, use_errno=True)
        if libc.prctl(number, *values, *(0,) * (4 - len(values))):
            raise OSError(ctypes.get_errno(), f"prctl({number}) was refused")


def end_with(ancestor: int) -> bool:
    """Ask Linux to end this process with its parent; return False where `ancestor` has ended already.

    Between the two a launcher may stand, as a virtual environment has one on Windows.
    """
    if not LINUX:  # nothing can be asked for, and so there is no race
        return True
    prctl(DIE_WITH_PARENT, signal.SIGKILL)
    one = os.getppid()
    while one not in (0, 1, ancestor):
        one = parent_of(one)
    return one == ancestor


def parent_of(process: int) -> int:
    """Return the parent of a process of Linux, or 0 where it is gone or cannot be seen."""
    try:
        with open(f"/proc/{process}/stat", encoding="utf8", errors="replace") as file:
            return int(file.read().rpartition(")")[2].split()[1])
    except (OSError, ValueError, IndexError):
        return 0


def limit(limits: dict[str, int], needed: bool) -> None:
    """Set the limits of this process: they are named as in the module resource, and never raised again.

    Where they are not `needed`, those that the system does not have, or does not grant, are let be.
    """
    lacks = () if needed else (AttributeError, ValueError, OSError)
    for name, most in limits.items():
        with contextlib.suppress(*lacks):
            which = getattr(resource, f"RLIMIT_{name}")
            _, hard = resource.getrlimit(which)
            most = most if hard == resource.RLIM_INFINITY else min(most, hard)
            resource.setrlimit(which, (most, most))


def restrict(program: bytes) -> None:
    """Give the kernel a seccomp program, which this process and its threads never lose."""

    class Program(ctypes.Structure):
        _fields_ = (("length", ctypes.c_ushort), ("filter", ctypes.c_char_p))

    prctl(NO_NEW_PRIVILEGES, 1)
    prctl(SECCOMP, 2, ctypes.byref(Program(len(program) // 8, program)))


def used() -> float:
    """Return the seconds of a processor that children have used so far, as far as the system tells."""
    if resource is None:
        return 0.0
    told = resource.getrusage(resource.RUSAGE_CHILDREN)
    return float(told.ru_utime + told.ru_stime)


def fork(control: socket.socket, begin: Callable[[socket.socket], object]) -> int:
    """Fork a process that begins with the link that comes over the control, and return its number."""
    _, descriptors, *_ = socket.recv_fds(control, 1, 1)
    pid = os.fork()
    if pid == 0:
        try:
            control.close()
            os.setpgid(0, 0)
            prctl(DIE_WITH_PARENT, signal.SIGKILL)
            begin(socket.socket(fileno=descriptors[0]))
        finally:
            os._exit(0)  # at once: the end of this program is the supervisor's
    os.close(descriptors[0])
    return pid


def children() -> list[int]:
    """Return the processes whose parent is this one, as far as the system tells."""
    with contextlib.suppress(OSError):  # there may be no /proc, or a fence before it
        numbers = map(int, filter(str.isdigit, os.listdir("/proc")))
        return [one for one in numbers if parent_of(one) == os.getpid()]
    return []


def signal_of(pid: int, seconds: float) -> int:
    """Return the signal that has ended a process, or ends it within some seconds; 0 where none does."""
    until = time.monotonic() + seconds
    while hasattr(os, "waitid"):
        with contextlib.suppress(ChildProcessError):
            found = os.waitid(os.P_PID, pid, os.WEXITED | os.WNOHANG | os.WNOWAIT)
            if found is not None:
                return found.si_status if found.si_code in (os.CLD_KILLED, os.CLD_DUMPED) else 0
        if time.monotonic() >= until:
            break
        time.sleep(0.002)
    return 0


def sweep(pid: int, alone: bool) -> None:
    """End a check's process and all that it started, and wait until they are gone.

    `alone` says that this is the first process of a namespace of its own, whose every other process
    is the check's.
    """
    with contextlib.suppress(OSError):
        if alone and os.getpid() == 1:
            os.kill(-1, signal.SIGKILL)
        else:
            os.kill(pid, signal.SIGKILL)
            os.killpg(pid, signal.SIGKILL)
    with contextlib.suppress(ChildProcessError):
        os.waitpid(pid, 0)
    while True:
        try:
            gone, _ = os.waitpid(-1, os.WNOHANG)
        except ChildProcessError:
            return
        if gone == 0:  # still dying, or a daemon that has left the group and was adopted
            for one in [] if alone else children():
                with contextlib.suppress(OSError):
                    os.kill(one, signal.SIGKILL)
            time.sleep(0.0005)


def inherit_control(number: str) -> socket.socket:
    """Return the control: it has this number or, on Windows, is described on the standard input."""
    if shared := getattr(socket, "fromshare", None):
        return shared(sys.stdin.buffer.read())
    return socket.socket(fileno=int(number))
