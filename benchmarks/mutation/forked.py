"""A process that has imported what tests need, but not hdrlab: for each line read, a child runs tests.

A line is JSON: {"tests": addresses, "seconds": at most so many}; the answer is pytest's exit code,
or -1 for a child that took longer. It is a script, so that nothing of hdrlab is imported.
"""

import importlib
import json
import os
import shutil
import signal
import sys
import time
from contextlib import suppress
from pathlib import Path

COMMON = (
    *(
        "numpy",
        "scipy.ndimage",
        "scipy.optimize",
        "scipy.sparse.linalg",
        "scipy.interpolate",
        "scipy.signal",
    ),
    *("scipy.stats", "scipy.fft", "scipy.spatial", "PIL.Image", "nbformat"),
    *(
        "matplotlib.figure",
        "pytest",
        "_pytest.tmpdir",
        "_pytest.junitxml",
        "IPython",
        "skimage.data",
    ),
)
TOO_LONG = -1


def child(tree: Path, tests: list[str]) -> None:
    """Run the tests in the tree until one fails, and end with pytest's code."""
    import pytest

    os.setsid()
    null = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(null, stream)
    base = tree.parent / f"{tree.name}-tmp"
    code = pytest.main(["-x", "-q", "--numprocesses=0", "--dist=no", f"--basetemp={base}", *tests])
    os._exit(int(code))


def ran(tree: Path, tests: list[str], seconds: float) -> int:
    """Return the exit code of a child that runs the tests."""
    pid = os.fork()
    if pid == 0:
        try:
            child(tree, tests)
        finally:
            os._exit(70)
    end = time.monotonic() + seconds
    code = None
    while code is None and time.monotonic() < end:
        done, status = os.waitpid(pid, os.WNOHANG)
        code = os.waitstatus_to_exitcode(status) if done else None
        time.sleep(0.02)
    with suppress(ProcessLookupError, PermissionError):
        os.killpg(pid, signal.SIGKILL)
    if code is None:
        os.waitpid(pid, 0)
    shutil.rmtree(tree.parent / f"{tree.name}-tmp", ignore_errors=True)
    return TOO_LONG if code is None else code


def main() -> None:
    """Serve the lines of stdin in the tree that is the working folder."""
    tree = Path.cwd()
    sys.path.insert(0, str(tree))
    for name in COMMON:
        importlib.import_module(name)
    for line in sys.stdin:
        request = json.loads(line)
        print(ran(tree, request["tests"], request["seconds"]), flush=True)


if __name__ == "__main__":
    main()
