"""Which calls of the kernel a submission may make: those that reading, computing and answering need.

All others are answered by "not permitted": no process can be started, no signal sent, no socket
made, no file moved or removed. A thread can be started. That no file can be opened for writing is
for the walls to say, all of which are read-only but /dev/null.
"""

import errno
import tempfile
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

from hdrlab.course.sandbox.running import Unavailable

CALLS: dict[str, list[str]] = tomllib.loads(
    Path(__file__).with_name("syscalls.toml").read_text("utf8")
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
        raise Unavailable(
            f"the filter of system calls needs pyseccomp and libseccomp: {error}"
        ) from None
    rules = pyseccomp.SyscallFilter(pyseccomp.ERRNO(errno.EPERM))
    more = CALLS["tending"] if name == "supervisor" else []
    for call in [*CALLS["computing"], *CALLS["reading"], *more]:
        try:
            number = pyseccomp.resolve_syscall(pyseccomp.Arch.NATIVE, call)
        except OSError:  # this processor lacks it
            continue
        if number >= 0:
            rules.add_rule(pyseccomp.ALLOW, number)
    if name == "check":
        _narrow(rules)
    with tempfile.TemporaryFile() as file:
        rules.export_bpf(file)
        file.seek(0)
        return file.read()


def _narrow(rules: Any) -> None:
    """Allow some calls with some arguments: to start a thread, to ask for one's limits."""
    from pyseccomp import ALLOW, EQ, ERRNO, MASKED_EQ, Arg

    rules.add_rule(ALLOW, "clone", Arg(0, MASKED_EQ, NEW_THREAD, NEW_THREAD))
    rules.add_rule(
        ERRNO(errno.ENOSYS), "clone3"
    )  # its flags lie in memory: the C library asks clone then
    rules.add_rule(ALLOW, "prlimit64", Arg(0, EQ, 0), Arg(2, EQ, 0))
    for order in FLAGS:
        rules.add_rule(ALLOW, "fcntl", Arg(1, EQ, order))
    for order in (GET_TERMINAL, NONBLOCKING, CLOSE_ON_EXEC, KEEP_ON_EXEC):
        rules.add_rule(ALLOW, "ioctl", Arg(1, EQ, order))
