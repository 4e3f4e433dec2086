"""Becoming another user, which root alone can: each sandbox gets a spare number for as long as it runs."""

import contextlib
import json
import socket
import sys
from pathlib import Path
from typing import Any

from hdrlab.course.sandbox import descent, running

SPARE = range(60706, 61184)  # no system gives these to anybody [systemd.io/UIDS-GIDS]


def lease() -> tuple[int, socket.socket]:
    """Return a user number that no other sandbox has, and what holds it until that is closed.

    Raises
    ------
    Unavailable
        Where none is left, or this container has none.
    """
    mapped = _mapped()
    for user in SPARE:
        if any(user in numbers for numbers in mapped):
            held = socket.socket(socket.AF_UNIX)
            with contextlib.suppress(OSError):
                held.bind(
                    f"\0hdrlab-user-{user}"
                )  # a name without a file, which nobody else can have
                return user, held
            held.close()
    raise running.Unavailable(f"no user number of {SPARE.start} to {SPARE.stop - 1} is free here")


def _mapped() -> list[range]:
    """Return the user numbers that there are in this namespace."""
    with contextlib.suppress(OSError):
        lines = Path("/proc/self/uid_map").read_text().splitlines()
        rows = [[int(word) for word in line.split()] for line in lines]
        return [range(first, first + count) for first, _, count in rows]
    return []


def descend(**order: Any) -> list[str]:
    """Return the command by which root does what an order to descent.py says."""
    python = getattr(sys, "_base_executable", sys.executable)
    return [python, "-I", "-S", "-B", str(descent.__file__), json.dumps(order)]
