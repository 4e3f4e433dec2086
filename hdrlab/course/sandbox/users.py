"""Lease spare user numbers, so that each sandbox that root starts runs as a user of its own."""

import json
import socket
import sys
from pathlib import Path
from typing import Any

from hdrlab.course.sandbox import descent, session

# systems assign these numbers to nobody [systemd.io/UIDS-GIDS]
SPARE_USERS = range(60706, 61184)


def lease() -> tuple[int, socket.socket]:
    """Lease a user number that no other sandbox has.

    Returns
    -------
    user : int
        The user number.
    lock : socket
        Holds the number until it is closed.

    Raises
    ------
    Unavailable
        If no number is free, or this container has none of them.
    """
    mapped_users = _mapped_users()
    for user in SPARE_USERS:
        if any(user in numbers for numbers in mapped_users):
            lock = socket.socket(socket.AF_UNIX)
            try:
                # an abstract socket name, which only one socket of the machine can have
                lock.bind(f"\0hdrlab-user-{user}")
            except OSError:
                lock.close()
            else:
                return user, lock
    first = SPARE_USERS.start
    last = SPARE_USERS.stop - 1
    raise session.Unavailable(f"no user number of {first} to {last} is free here")


def _mapped_users() -> list[range]:
    """Return the user numbers that exist in this user namespace."""
    try:
        text = Path("/proc/self/uid_map").read_text()
    except OSError:
        return []
    ranges = []
    for line in text.splitlines():
        first, _, count = (int(word) for word in line.split())
        ranges.append(range(first, first + count))
    return ranges


def descend(**order: Any) -> list[str]:
    """Return the command that root runs to carry out an order; see `descent.main` for the order."""
    python = getattr(sys, "_base_executable", sys.executable)
    return [python, "-I", "-S", "-B", str(descent.__file__), json.dumps(order)]
