"""The system calls that a sandbox may make: those that reading files and computing need.

All others fail with "not permitted", so a check cannot start a process, send a signal, make a
socket, or move or remove a file. It can start threads. The filter does not keep it from opening a
file for writing; for that, everything in the sandbox is mounted read-only except /dev/null.
"""

import errno
import tempfile
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

from hdrlab.course.sandbox.session import Unavailable

# names of system calls, by purpose: "computing", "reading" and "supervising"
SYSTEM_CALLS: dict[str, list[str]] = tomllib.loads(
    Path(__file__).with_name("syscalls.toml").read_text("utf8")
)
# flag of clone for a thread, from <sched.h>
CLONE_THREAD = 0x10000
# requests of ioctl, from <asm-generic/ioctls.h>
TCGETS = 0x5401
FIONBIO = 0x5421
FIONCLEX = 0x5450
FIOCLEX = 0x5451
ALLOWED_IOCTL_REQUESTS = (TCGETS, FIONBIO, FIOCLEX, FIONCLEX)
# commands of fcntl, from <linux/fcntl.h>
F_DUPFD = 0
F_GETFD = 1
F_SETFD = 2
F_GETFL = 3
F_SETFL = 4
F_DUPFD_CLOEXEC = 1030
ALLOWED_FCNTL_COMMANDS = (F_DUPFD, F_GETFD, F_SETFD, F_GETFL, F_SETFL, F_DUPFD_CLOEXEC)


@cache
def program(name: str) -> bytes:
    """Return a filter of system calls as a seccomp program.

    Parameters
    ----------
    name : str
        "supervisor", or "check" for the narrower filter of a check's process.

    Raises
    ------
    Unavailable
        If libseccomp or its Python binding is not installed.
    """
    try:
        import pyseccomp
    except (ImportError, RuntimeError) as error:
        raise Unavailable(
            f"the filter of system calls needs pyseccomp and libseccomp: {error}"
        ) from None
    rules = pyseccomp.SyscallFilter(pyseccomp.ERRNO(errno.EPERM))
    system_calls = SYSTEM_CALLS["computing"] + SYSTEM_CALLS["reading"]
    if name == "supervisor":
        system_calls += SYSTEM_CALLS["supervising"]
    for system_call in system_calls:
        try:
            number = pyseccomp.resolve_syscall(pyseccomp.Arch.NATIVE, system_call)
        except OSError:
            # this processor lacks it
            continue
        # a call that this processor lacks may also have a number below zero
        if number >= 0:
            rules.add_rule(pyseccomp.ALLOW, number)
    if name == "check":
        _allow_some_arguments(rules)
    with tempfile.TemporaryFile() as file:
        rules.export_bpf(file)
        file.seek(0)
        return file.read()


def _allow_some_arguments(rules: Any) -> None:
    """Allow some system calls with harmless arguments, for example clone for a thread."""
    from pyseccomp import ALLOW, EQ, ERRNO, MASKED_EQ, Arg

    is_thread = Arg(0, MASKED_EQ, CLONE_THREAD, CLONE_THREAD)
    rules.add_rule(ALLOW, "clone", is_thread)
    # a filter cannot see the flags of clone3, which lie in memory; without clone3 the C library
    # uses clone
    rules.add_rule(ERRNO(errno.ENOSYS), "clone3")
    is_own_process = Arg(0, EQ, 0)
    sets_no_limit = Arg(2, EQ, 0)
    rules.add_rule(ALLOW, "prlimit64", is_own_process, sets_no_limit)
    for fcntl_command in ALLOWED_FCNTL_COMMANDS:
        rules.add_rule(ALLOW, "fcntl", Arg(1, EQ, fcntl_command))
    for ioctl_request in ALLOWED_IOCTL_REQUESTS:
        rules.add_rule(ALLOW, "ioctl", Arg(1, EQ, ioctl_request))
