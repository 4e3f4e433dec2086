"""Environments in which something is missing or wrong: a home, cache folders, UTF-8, the clock."""

import os

# Each call of time.time() returns a time one minute earlier than the true one and its predecessor.
BACKWARD_CLOCK = """import itertools
import time

true_time = time.time
counter = itertools.count()
time.time = lambda: true_time() - 60 * next(counter)
"""
MISSING_FOLDER = "/proc/nowhere"  # nobody can create it, not even root
FUTURE_TIMESTAMP = 4e9  # seconds since 1970: the year 2096
# The variables that a test sets; None removes a variable.
ENVIRONMENTS = {
    "no HOME": {"HOME": None, "XDG_CACHE_HOME": None},
    "no caches": {
        "HOME": MISSING_FOLDER,
        "XDG_CACHE_HOME": MISSING_FOLDER,
        "MPLCONFIGDIR": MISSING_FOLDER,
    },
    "LANG=C": {"LANG": "C", "LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
}


def turn_clock_back(folder):
    """Date all files of a folder in the future and return a PYTHONPATH that turns the clock back.

    The clock of a Python process with this PYTHONPATH loses a minute whenever it is read.
    """
    clock_folder = folder.parent / "clock"
    clock_folder.mkdir()
    (clock_folder / "sitecustomize.py").write_text(BACKWARD_CLOCK)
    for path in folder.rglob("*"):
        os.utime(path, (FUTURE_TIMESTAMP, FUTURE_TIMESTAMP))
    paths = [str(clock_folder)]
    if os.environ.get("PYTHONPATH"):
        paths.append(os.environ["PYTHONPATH"])
    return os.pathsep.join(paths)
