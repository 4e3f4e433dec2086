"""The strict tier: bubblewrap, a user of its own, limits, and a filter of system calls.

The sandbox contains the interpreter, numpy and scipy, all of them read-only. There is no network,
no other process, no /proc, no place for a file, no environment variable of the grader, no
privilege, and no way to get one. The process of a check has a narrower filter: see filters.py.
"""

import os
import shutil
import subprocess
import sys
from collections.abc import Mapping
from contextlib import ExitStack
from functools import cache, partial
from socket import socket
from typing import BinaryIO

from hdrlab.course.sandbox import descent, filters, users
from hdrlab.course.sandbox.contents import PYTHON, SandboxMounts, contents
from hdrlab.course.sandbox.session import (
    ENVIRONMENT,
    RULES,
    Sandbox,
    SandboxProcess,
    Unavailable,
    start_process,
    supervisor_command,
)

BUBBLEWRAP_OPTIONS: list[str] = RULES["strict"]["options"]
# options that tell bubblewrap 0.8 and later from earlier versions
REQUIRED_OPTIONS: list[str] = RULES["strict"]["required_options"]
ROOT_USER = 0


def sandbox() -> Sandbox:
    """Return the strict tier.

    Raises
    ------
    Unavailable
        If the system is not Linux, or bubblewrap or libseccomp is missing or too old.
    """
    if sys.platform != "linux":
        raise Unavailable(f"the strict tier needs Linux, and this is {sys.platform}")
    seccomp_program = filters.program("check")
    return Sandbox(
        tier="strict",
        credit=True,
        launch=partial(launch, bubblewrap()),
        seccomp_program=seccomp_program,
        has_pid_namespace=True,
    )


@cache
def bubblewrap() -> str:
    """Return the path of bubblewrap; raise Unavailable if it is missing or too old."""
    path = shutil.which("bwrap")
    if path is None:
        raise Unavailable("the strict tier needs bubblewrap, and there is no bwrap on the path")
    result = subprocess.run(
        [path, "--help"], capture_output=True, text=True, stdin=subprocess.DEVNULL
    )
    help_text = result.stdout + result.stderr
    for option in REQUIRED_OPTIONS:
        if option not in help_text:
            raise Unavailable(
                f"the strict tier needs bubblewrap 0.8 or later; {path} does not know {option}"
            )
    return path


def bubblewrap_options(
    mounts: SandboxMounts, sources: Mapping[str, str], filter_descriptor: int
) -> list[str]:
    """Return bubblewrap's options.

    Parameters
    ----------
    mounts : SandboxMounts
        What the sandbox contains.
    sources : mapping
        The path outside for each path inside. It differs from `mounts.places` for root, whose
        places are bound elsewhere first.
    filter_descriptor : int
        Descriptor from which bubblewrap reads the supervisor's filter of system calls.
    """
    options = list(BUBBLEWRAP_OPTIONS)
    environment = ENVIRONMENT | {"LD_LIBRARY_PATH": f"{PYTHON}/lib"}
    for name, value in environment.items():
        options += ["--setenv", name, value]
    # sorted, so that a folder comes before what lies in it
    for place in sorted(sources):
        options += ["--ro-bind", sources[place], place]
    for folder in mounts.hidden:
        options += ["--perms", "0555", "--size", "4096", "--tmpfs", folder]
        options += ["--remount-ro", folder]
    options += ["--dev-bind", os.devnull, os.devnull]
    options += ["--remount-ro", "/"]
    options += ["--chdir", "/"]
    options += ["--seccomp", str(filter_descriptor)]
    return [*options, "--"]


def launch(bwrap: str, control: socket) -> SandboxProcess:
    """Start the supervisor in bubblewrap. Root becomes a spare user first.

    Parameters
    ----------
    bwrap : str
        The path of bubblewrap.
    control : socket
        The supervisor's end of the control socket.
    """
    mounts = contents()
    supervisor = supervisor_command(
        mounts.python, mounts.program, control.fileno(), mounts.packages
    )
    with ExitStack() as stack, _open_for_reading(filters.program("supervisor")) as rules:
        sources = mounts.places
        if os.geteuid() == ROOT_USER:
            sources = {place: f"{descent.STAGE}/{j}" for j, place in enumerate(mounts.places)}
        options = bubblewrap_options(mounts, sources, rules.fileno())
        command = [bwrap, *options, *supervisor]
        if os.geteuid() == ROOT_USER:
            user, lease = users.lease()
            stack.enter_context(lease)
            paths = list(mounts.places.values())
            command = users.descend(user=user, stage=paths, command=command, environment={})
        process = start_process(command, {}, pass_fds=[control.fileno(), rules.fileno()])
        # the lease is held until the process has ended
        return SandboxProcess(process=process, clean_up=stack.pop_all().close)


def _open_for_reading(program: bytes) -> BinaryIO:
    """Return an open file from which a program of a few thousand bytes can be read."""
    read_descriptor, write_descriptor = os.pipe()
    # a pipe holds that much, so this does not wait for the reader
    with open(write_descriptor, "wb") as file:
        file.write(program)
    return open(read_descriptor, "rb")
