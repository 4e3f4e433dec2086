"""The first process in a sandbox: it imports numpy once, forks a process per check, and clears up behind it.

control  the socket to the parent, on which orders come and answers go: see `tend`
link     the socket of one check, which the parent sends over the control

What a check has left behind ends with it: its memory, its processes, its files. The student's code never runs
in this process. Like worker.py and channel.py, which stand beside it in the sandbox, it needs the standard
library and numpy alone.
"""

import contextlib
import ctypes
import gc
import importlib
import importlib.util
import os
import shutil
import signal
import socket
import sys
import time
from typing import Any

DIE_WITH_PARENT, ADOPT, SECCOMP, NO_NEW_PRIVILEGES = 1, 36, 22, 38  # prctl's numbers


class PackageFinder:
    """Finds the packages that a submission may import, and what stands beside this file, and nothing else.

    No folder is put on sys.path: one that holds numpy holds much else.
    """

    def __init__(self, files: dict[str, str]) -> None:
        self.files = files

    def find_spec(self, name: str, path: Any = None, target: Any = None) -> Any:
        """Return where a top-level module is, or None; what lies inside of it is found as ever."""
        if path is not None or name not in self.files:
            return None
        file = self.files[name]
        inside = [os.path.dirname(file)] if file.endswith("__init__.py") else None
        return importlib.util.spec_from_file_location(name, file, submodule_search_locations=inside)


def prctl(number: int, *values: Any) -> None:
    """Ask Linux for a property of this process; other systems are left alone."""
    if sys.platform == "linux":
        libc = ctypes.CDLL(None, use_errno=True)
        if libc.prctl(number, *values, *(0,) * (4 - len(values))):
            raise OSError(ctypes.get_errno(), f"prctl({number}) was refused")


def limit(limits: dict[str, int], needed: bool) -> None:
    """Set the limits of this process: they are named as in the module resource, and never raised again.

    Where they are not `needed`, those that the system does not have, or does not grant, are let be.
    """
    lacks = () if needed else (ImportError, AttributeError, ValueError, OSError)
    for name, most in limits.items():
        with contextlib.suppress(*lacks):
            resource = importlib.import_module("resource")
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


def begin(link: socket.socket, order: dict[str, Any]) -> None:
    """Become the process of a check: limited, filtered, and with nothing but its link."""
    worker, channel = importlib.import_module("worker"), importlib.import_module("channel")
    limit(order["limits"], order["credit"])
    if order["filter"]:
        restrict(order["filter"])
    worker.serve(link, channel)


def fork(control: socket.socket, order: dict[str, Any]) -> int:
    """Fork the process of a check, whose link comes over the control, and return its number."""
    _, descriptors, *_ = socket.recv_fds(control, 1, 1)
    pid = os.fork()
    if pid == 0:
        try:
            control.close()
            os.setpgid(0, 0)
            prctl(DIE_WITH_PARENT, signal.SIGKILL)
            begin(socket.socket(fileno=descriptors[0]), order)
        finally:
            os._exit(0)  # at once: the end of this program is the supervisor's
    os.close(descriptors[0])
    return pid


def children() -> list[int]:
    """Return the processes whose parent is this one, as far as the system tells."""
    found = []
    with contextlib.suppress(OSError):  # there may be no /proc, or a fence before it
        for entry in filter(str.isdigit, os.listdir("/proc")):
            with contextlib.suppress(OSError, ValueError, IndexError):  # it may be gone meanwhile
                with open(f"/proc/{entry}/stat") as file:
                    parent = int(file.read().rpartition(")")[2].split()[1])
                if parent == os.getpid():
                    found.append(int(entry))
    return found


def used() -> float:
    """Return the seconds of a processor that checks have used so far, as far as the system tells."""
    with contextlib.suppress(ImportError):
        resource = importlib.import_module("resource")
        told = resource.getrusage(resource.RUSAGE_CHILDREN)
        return float(told.ru_utime + told.ru_stime)
    return 0.0


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

    `alone` says that this is the first process of a namespace of its own, whose every other process is the
    check's.
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


def tend(control: socket.socket, channel: Any, order: dict[str, Any]) -> None:
    """Fork a process for each check that is ordered, until the other end closes.

    "check" comes with the seconds of a processor that it may use and a descriptor, the new process's link,
    and is answered by "begun". "end" comes with the seconds in which it is expected to end by itself, and is
    answered, when nothing of the check is left, by "clean" with the signal that has ended it, or 0, and the
    seconds it has used.
    """
    pid, before = 0, 0.0
    try:
        while True:
            kind, call, seconds = channel.receive(control)
            if kind == "check":
                before = used()
                limits = order["limits"] | {"CPU": min(seconds, order["limits"]["CPU"])}
                pid = fork(control, order | {"limits": limits})
                channel.send(control, "begun", call=call)
            else:
                ended = signal_of(pid, seconds)
                sweep(pid, order["alone"])
                channel.send(control, "clean", (ended, used() - before), call)
                pid = 0
    except EOFError:
        if pid:
            sweep(pid, order["alone"])


def prepare(modules: list[str]) -> None:
    """Import what the checks will need, once, and begin numpy's old random numbers at one place."""
    for name in ("numpy.random", "worker", *modules):
        with contextlib.suppress(ImportError):  # the submission will say so itself, where it asks for it
            importlib.import_module(name)
    sys.modules["numpy.random"].seed(0)
    gc.collect()
    gc.freeze()  # a fork then shares these pages


def inherit_control(number: str) -> socket.socket:
    """Return the control: it has this number or, on Windows, is described on the standard input."""
    if sys.platform == "win32":
        return socket.fromshare(sys.stdin.buffer.read())
    return socket.socket(fileno=int(number))


def main(number: str, *packages: str) -> None:
    """Read the first order from the control, make ready, and tend the checks, or be the only one there is."""
    control = inherit_control(number)
    here = os.path.dirname(os.path.abspath(__file__))
    shelf = {name: f"{here}/{name}.py" for name in ("channel", "worker")}
    for package in packages:
        name, _, folder = package.partition("=")
        shelf[name] = f"{folder}/__init__.py"
    sys.meta_path.append(PackageFinder(shelf))
    channel = importlib.import_module("channel")
    _, _, order = channel.receive(control)
    for one in ("SIGINT", "SIGTERM", "SIGHUP"):
        if hasattr(signal, one):  # the first process of a namespace does not feel its default from inside
            signal.signal(getattr(signal, one), signal.SIG_DFL)
    prctl(ADOPT, 1)
    prepare(order["modules"])
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 2)  # what a library might still write there is for nobody
    os.close(nowhere)
    channel.send(control, "ready")
    if order["forks"]:
        tend(control, channel, order)
    else:
        begin(control, order)
    if order["scratch"]:  # the parent may have been killed, and cannot
        shutil.rmtree(order["scratch"], ignore_errors=True)
    os._exit(0)  # nothing is left that would need an orderly end


if __name__ == "__main__":
    main(*sys.argv[1:])
