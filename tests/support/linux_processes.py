"""Find processes of this machine in /proc. Any of them may end while a test reads about it."""

import os
from contextlib import suppress
from pathlib import Path


def read_proc_files(name):
    """Return the bytes of a file of /proc/NUMBER for each process, by its number."""
    contents = {}
    for entry in os.listdir("/proc"):
        if entry.isdigit():
            with suppress(OSError):
                contents[int(entry)] = Path("/proc", entry, name).read_bytes()
    return contents


def processes_using(folder):
    """Return the numbers of the processes whose environment names a folder, such as their TMPDIR."""
    folder_bytes = os.fsencode(folder)
    return [
        number
        for number, environment in read_proc_files("environ").items()
        if folder_bytes in environment
    ]
