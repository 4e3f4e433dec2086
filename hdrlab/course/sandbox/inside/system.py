"""Calls of the operating system, some of which only Linux or POSIX has.

No other module of hdrlab imports what only POSIX has. This file goes into the sandbox, where hdrlab
is not: it needs the standard library alone.
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

# options of prctl, from <linux/prctl.h>
PR_SET_PDEATHSIG = 1
PR_SET_SECCOMP = 22
PR_SET_CHILD_SUBREAPER = 36
PR_SET_NO_NEW_PRIVS = 38
# prctl takes this many arguments after the option
PRCTL_ARGUMENTS = 4
SECCOMP_MODE_FILTER = 2
SECCOMP_INSTRUCTION_BYTES = 8

SIGNAL_POLL_SECONDS = 0.002
END_POLL_SECONDS = 0.0005


def _import_if_available(name: str) -> Any:
    """Return a module of the standard library, or None if this system lacks it."""
    try:
        return importlib.import_module(name)
    except ImportError:
        return None


resource = _import_if_available("resource")


def prctl(option: int, *values: Any) -> None:
    """Set a property of this process on Linux; do nothing on other systems."""
    if not LINUX:
        return
    libc = ctypes.CDLL(None, use_errno=True)
    padding = [0] * (PRCTL_ARGUMENTS - len(values))
    if libc.prctl(option, *values, *padding) != 0:
        raise OSError(ctypes.get_errno(), f"prctl({option}) was refused")


def die_with_parent(ancestor: int) -> bool:
    """Let Linux kill this process when its parent ends.

    Parameters
    ----------
    ancestor : int
        The process that started this one. Launchers may stand between the two, as in a virtual
        environment on Windows.

    Returns
    -------
    bool
        False if the ancestor has ended already, in which case nothing will kill this process.
    """
    # other systems have no such request, so there is nothing that could come too late
    if not LINUX:
        return True
    prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    process = os.getppid()
    while process not in (0, 1, ancestor):
        process = parent_of(process)
    return process == ancestor


def parent_of(process: int) -> int:
    """Return the parent of a process on Linux, or 0 if the process is gone or cannot be seen."""
    try:
        with open(f"/proc/{process}/stat", encoding="utf8", errors="replace") as file:
            # the command's name is in parentheses, and may contain spaces and parentheses itself
            _, _, fields_after_name = file.read().rpartition(")")
            return int(fields_after_name.split()[1])
    except (OSError, ValueError, IndexError):
        return 0


def adopt_orphans() -> None:
    """Let Linux make this process the parent of descendants whose own parent has ended."""
    prctl(PR_SET_CHILD_SUBREAPER, 1)


def set_limits(limits: dict[str, int], *, required: bool) -> None:
    """Set the limits of this process, which it cannot raise again.

    Parameters
    ----------
    limits : dict
        Limits by their names in the module `resource`, without RLIMIT_.
    required : bool
        Whether a limit that the system lacks or refuses is an error. If not, it is left out.
    """
    tolerated = () if required else (AttributeError, ValueError, OSError)
    for name, limit in limits.items():
        with contextlib.suppress(*tolerated):
            kind = getattr(resource, f"RLIMIT_{name}")
            _, hard_limit = resource.getrlimit(kind)
            if hard_limit != resource.RLIM_INFINITY:
                limit = min(limit, hard_limit)
            resource.setrlimit(kind, (limit, limit))


def install_seccomp_filter(program: bytes) -> None:
    """Filter the system calls of this process and its threads, for good."""

    class SeccompProgram(ctypes.Structure):
        """struct sock_fprog of the kernel."""

        _fields_ = (("length", ctypes.c_ushort), ("filter", ctypes.c_char_p))

    prctl(PR_SET_NO_NEW_PRIVS, 1)
    instruction_count = len(program) // SECCOMP_INSTRUCTION_BYTES
    filter_program = SeccompProgram(instruction_count, program)
    prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, ctypes.byref(filter_program))


def children_cpu_seconds() -> float:
    """Return the processor time of all children that have ended, or 0 if the system does not tell."""
    if resource is None:
        return 0.0
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return float(usage.ru_utime + usage.ru_stime)


def fork_check(control: socket.socket, begin: Callable[[socket.socket], object]) -> int:
    """Fork the process of a check, and return its number.

    Parameters
    ----------
    control : socket
        The grader sends the link of the check over this socket.
    begin : callable
        Called in the new process with the link. The process ends when it returns.
    """
    _, descriptors, _, _ = socket.recv_fds(control, 1, 1)
    pid = os.fork()
    if pid == 0:
        try:
            control.close()
            os.setpgid(0, 0)
            prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
            begin(socket.socket(fileno=descriptors[0]))
        finally:
            # at once, so that this process never returns into the supervisor's code
            os._exit(0)
    os.close(descriptors[0])
    return pid


def list_children() -> list[int]:
    """Return the child processes of this process, or none if the system does not tell."""
    try:
        names = os.listdir("/proc")
    except OSError:
        # there is no /proc, or this process may not read it
        return []
    processes = [int(name) for name in names if name.isdigit()]
    return [process for process in processes if parent_of(process) == os.getpid()]


def wait_for_signal(pid: int, timeout: float) -> int:
    """Wait for a child to end, and return the signal that ended it.

    Return 0 if no signal ended it, it did not end within `timeout` seconds, or the system does not
    tell.
    """
    if not hasattr(os, "waitid"):
        return 0
    deadline = time.monotonic() + timeout
    while True:
        with contextlib.suppress(ChildProcessError):
            # WNOWAIT leaves the child to be waited for by end_check
            result = os.waitid(os.P_PID, pid, os.WEXITED | os.WNOHANG | os.WNOWAIT)
            if result is not None:
                was_signaled = result.si_code in (os.CLD_KILLED, os.CLD_DUMPED)
                return result.si_status if was_signaled else 0
        if time.monotonic() >= deadline:
            return 0
        time.sleep(SIGNAL_POLL_SECONDS)


def end_check(pid: int, has_pid_namespace: bool) -> None:
    """Kill the process of a check and everything that it started, and wait until all are gone.

    Parameters
    ----------
    pid : int
        The process of the check.
    has_pid_namespace : bool
        Whether this is the first process of a PID namespace of its own. Every other process in
        there belongs to the check.
    """
    with contextlib.suppress(OSError):
        if has_pid_namespace and os.getpid() == 1:
            # every other process of the namespace
            os.kill(-1, signal.SIGKILL)
        else:
            os.kill(pid, signal.SIGKILL)
            os.killpg(pid, signal.SIGKILL)
    with contextlib.suppress(ChildProcessError):
        os.waitpid(pid, 0)
    while _has_children_after_reaping():
        # a child is still dying, or it is a daemon that left the process group and was adopted
        if not has_pid_namespace:
            for child in list_children():
                with contextlib.suppress(OSError):
                    os.kill(child, signal.SIGKILL)
        time.sleep(END_POLL_SECONDS)


def _has_children_after_reaping() -> bool:
    """Remove all children that have ended from the process table; return whether any are left."""
    while True:
        try:
            ended_child, _ = os.waitpid(-1, os.WNOHANG)
        except ChildProcessError:
            return False
        if ended_child == 0:
            return True


def inherit_control(number: str) -> socket.socket:
    """Return the control socket, which has this descriptor.

    On Windows, the grader describes the socket on the standard input instead.
    """
    from_share = getattr(socket, "fromshare", None)
    if from_share is not None:
        return from_share(sys.stdin.buffer.read())
    return socket.socket(fileno=int(number))
