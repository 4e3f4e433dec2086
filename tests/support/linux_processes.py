"""What /proc says of the processes of this machine, any of which may end while it is asked."""

import os
from contextlib import suppress
from pathlib import Path


def told(file):
    """Return what this file of /proc says of each process, by its number."""
    found = {}
    for entry in filter(str.isdigit, os.listdir("/proc")):
        with suppress(OSError):
            found[int(entry)] = Path(f"/proc/{entry}/{file}").read_bytes()
    return found


def of(folder):
    """Return the processes whose environment names this folder, as where their scratch is."""
    return [
        one for one, environment in told("environ").items() if str(folder).encode() in environment
    ]
