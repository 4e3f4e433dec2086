"""The strict tier: bubblewrap, a user of its own, limits, and a filter of system calls.

Inside there is the interpreter, numpy and scipy, all to be read only; no network, no other process,
no /proc, no place for a file, no environment, no privilege, and no way to get one. The process of a
check is filtered once more: see filters.py.
"""

import contextlib
import os
import shutil
import subprocess
import sys
from functools import cache, partial
from socket import socket
from typing import BinaryIO

from hdrlab.course.sandbox import descent, filters, users
from hdrlab.course.sandbox.contents import PYTHON, SandboxMounts, contents
from hdrlab.course.sandbox.running import (
    ENVIRONMENT,
    RULES,
    Sandbox,
    SandboxProcess,
    Unavailable,
    command,
    start,
)

WALLS, NEEDED = RULES["strict"]["walls"], RULES["strict"]["needed"]


def sandbox() -> Sandbox:
    """Return the strict tier.

    Raises
    ------
    Unavailable
        Where the system is not Linux, or bubblewrap or libseccomp is missing or too old.
    """
    if sys.platform != "linux":
        raise Unavailable(f"the strict tier needs Linux, and this is {sys.platform}")
    program = filters.program("check")
    return Sandbox("strict", True, partial(launch, bubblewrap()), program=program, alone=True)


@cache
def bubblewrap() -> str:
    """Return where bubblewrap is, if it is new enough, or raise Unavailable."""
    path = shutil.which("bwrap")
    if path is None:
        raise Unavailable("the strict tier needs bubblewrap, and there is no bwrap on the path")
    told = subprocess.run(
        [path, "--help"], capture_output=True, text=True, stdin=subprocess.DEVNULL
    )
    missing = [option for option in NEEDED if option not in told.stdout + told.stderr]
    if missing:
        raise Unavailable(
            f"the strict tier needs bubblewrap 0.8 or later; {path} does not know {missing[0]}"
        )
    return path


def walls(inside: SandboxMounts, sources: dict[str, str], rules: int) -> list[str]:
    """Return bubblewrap's options.

    `sources` says where the places of the inside are outside, and `rules` is the filter's
    descriptor.
    """
    options = list(WALLS)
    for name, value in (ENVIRONMENT | {"LD_LIBRARY_PATH": f"{PYTHON}/lib"}).items():
        options += ["--setenv", name, value]
    for place in sorted(sources):  # a folder before what lies in it
        options += ["--ro-bind", sources[place], place]
    for folder in inside.hidden:
        options += ["--perms", "0555", "--size", "4096", "--tmpfs", folder, "--remount-ro", folder]
    options += ["--dev-bind", os.devnull, os.devnull]
    return [*options, "--remount-ro", "/", "--chdir", "/", "--seccomp", str(rules), "--"]


def launch(bwrap: str, control: socket) -> SandboxProcess:
    """Start the supervisor behind the walls; root becomes a spare user first."""
    inside = contents()
    supervisor = command(inside.python, inside.program, control.fileno(), inside.packages)
    with contextlib.ExitStack() as held, _readable(filters.program("supervisor")) as rules:
        words = [bwrap, *walls(inside, inside.places, rules.fileno()), *supervisor]
        if os.geteuid() == 0:  # without a user, bubblewrap leaves nothing to clear up
            user, lease = users.lease()
            held.enter_context(lease)
            staged = {place: f"{descent.STAGE}/{j}" for j, place in enumerate(inside.places)}
            words = [bwrap, *walls(inside, staged, rules.fileno()), *supervisor]
            paths = list(inside.places.values())
            words = users.descend(user=user, stage=paths, command=words, environment={})
        return SandboxProcess(
            start(words, {}, control.fileno(), rules.fileno()), held.pop_all().close
        )


def _readable(program: bytes) -> BinaryIO:
    """Return a file from which a program of a few thousand bytes can be read."""
    ours, theirs = os.pipe()
    with open(theirs, "wb") as begin:
        begin.write(program)
    return open(ours, "rb")
