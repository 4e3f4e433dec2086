"""Which calls of the kernel a submission may make: those that reading, computing and answering need.

All others are answered by "not permitted": no process can be started, no signal sent, no socket made, no file
moved or removed. A thread can be started. That no file can be opened for writing is for the walls to say, all
of which are read-only but /dev/null.
"""

import errno
import os
from collections.abc import Iterable
from functools import cache
from typing import Any

from hdrlab.course.sandbox.running import Unavailable

COMPUTING = (  # memory, threads, clocks and itself
    *("mmap", "munmap", "mremap", "mprotect", "madvise", "brk", "mincore"),
    *("futex", "set_robust_list", "get_robust_list", "rseq", "membarrier", "set_tid_address", "arch_prctl"),
    *("rt_sigaction", "rt_sigprocmask", "rt_sigreturn", "sigaltstack", "restart_syscall"),
    *("alarm", "setitimer", "getitimer", "nanosleep", "clock_nanosleep", "clock_gettime", "clock_getres"),
    *("gettimeofday", "time", "times", "getrusage", "getrlimit", "getrandom", "uname", "sysinfo", "getcpu"),
    *("sched_yield", "sched_getaffinity", "sched_getparam", "sched_getscheduler", "getpriority"),
    *("getpid", "gettid", "getppid", "getpgrp", "getpgid", "getsid", "capget"),
    *("getuid", "geteuid", "getgid", "getegid", "getresuid", "getresgid", "getgroups"),
    *("exit", "exit_group"),
)
READING = (  # files, and the one socket that it was given
    *("open", "openat", "close", "close_range", "read", "readv", "pread64", "preadv", "write", "writev"),
    *("lseek", "dup", "dup2", "dup3", "stat", "fstat", "lstat", "newfstatat", "statx", "statfs", "fstatfs"),
    *("access", "faccessat", "faccessat2", "getdents", "getdents64", "getcwd", "readlink", "readlinkat"),
    *("fadvise64", "poll", "ppoll", "select", "pselect6"),
    *("recvfrom", "sendto", "getsockopt", "getsockname", "shutdown"),
)
TENDING = (  # what the supervisor needs beside
    *("fork", "vfork", "clone", "clone3", "execve", "wait4", "waitid", "kill", "setpgid", "setsid"),
    *("prctl", "seccomp", "setrlimit", "prlimit64", "recvmsg", "sendmsg", "fcntl", "ioctl"),
)
NEW_THREAD = 0x10000
GET_TERMINAL, NONBLOCKING, CLOSE_ON_EXEC, KEEP_ON_EXEC = 0x5401, 0x5421, 0x5451, 0x5450
FLAGS = (0, 1, 2, 3, 4, 1030)  # fcntl's: to duplicate, and to get and set flags


@cache
def program(name: str) -> bytes:
    """Return the filter of the "supervisor" or of a "check" as a program for the kernel.

    Raises
    ------
    Unavailable
        Where libseccomp or its binding is not installed.
    """
    try:
        import pyseccomp
    except (ImportError, RuntimeError) as error:
        raise Unavailable(f"the filter of system calls needs pyseccomp and libseccomp: {error}") from None
    rules = pyseccomp.SyscallFilter(pyseccomp.ERRNO(errno.EPERM))
    _allow(rules, (*COMPUTING, *READING, *(TENDING if name == "supervisor" else ())))
    if name == "check":
        _narrow(rules)
    return _exported(rules)


def _allow(rules: Any, names: Iterable[str]) -> None:
    """Allow the calls of these names, as far as this processor has them."""
    import pyseccomp

    for name in names:
        try:
            number = pyseccomp.resolve_syscall(pyseccomp.Arch.NATIVE, name)
        except OSError:
            continue
        if number >= 0:
            rules.add_rule(pyseccomp.ALLOW, number)


def _narrow(rules: Any) -> None:
    """Allow some calls with some arguments: to start a thread, to ask for one's limits."""
    from pyseccomp import ALLOW, EQ, ERRNO, MASKED_EQ, Arg

    rules.add_rule(ALLOW, "clone", Arg(0, MASKED_EQ, NEW_THREAD, NEW_THREAD))
    rules.add_rule(ERRNO(errno.ENOSYS), "clone3")  # its flags lie in memory: the C library asks clone then
    rules.add_rule(ALLOW, "prlimit64", Arg(0, EQ, 0), Arg(2, EQ, 0))
    for order in FLAGS:
        rules.add_rule(ALLOW, "fcntl", Arg(1, EQ, order))
    for order in (GET_TERMINAL, NONBLOCKING, CLOSE_ON_EXEC, KEEP_ON_EXEC):
        rules.add_rule(ALLOW, "ioctl", Arg(1, EQ, order))


def _exported(rules: Any) -> bytes:
    """Return a filter as bytes."""
    ours, theirs = os.pipe()
    with open(ours, "rb") as end:
        with open(theirs, "wb") as begin:  # a few thousand bytes, which a pipe holds
            rules.export_bpf(begin)
        return end.read()
