"""What a machine may lack: a home, a place for caches, signs beyond ASCII, a clock that goes forward."""

import os

CLOCK = """import itertools, time
true = time.time
late = itertools.count()
time.time = lambda: true() - 60 * next(late)
"""
NOWHERE = "/proc/nowhere"
# by what is lacking, the environment without it; None for a name that it has not
POOR = {
    "no HOME": {"HOME": None, "XDG_CACHE_HOME": None},
    "no caches": {"HOME": NOWHERE, "XDG_CACHE_HOME": NOWHERE, "MPLCONFIGDIR": NOWHERE},
    "LANG=C": {"LANG": "C", "LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
}


def turn_clock_back(here):
    """Return where Python finds a clock that loses a minute at each look, and files from the future."""
    (here.parent / "clock").mkdir()
    (here.parent / "clock/sitecustomize.py").write_text(CLOCK)
    for path in here.rglob("*"):
        os.utime(path, (4e9, 4e9))
    return os.pathsep.join(
        [str(here.parent / "clock"), *filter(None, [os.environ.get("PYTHONPATH")])]
    )
