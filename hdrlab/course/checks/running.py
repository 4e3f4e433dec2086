"""The specification is run by pytest, in a process of its own that the student's code never enters."""

import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from hdrlab.course.checks import SPECIFICATION
from hdrlab.course.sandbox.subprocess_runner import import_path
from hdrlab.errors import InputError

TICK = 0.02  # seconds between two looks at what has come
UNWANTED = ("PYTEST_ADDOPTS", "PYTEST_PLUGINS", "PYTHONSTARTUP", "PYTHONINSPECT")


def run(
    folder: Path, job: Path, files: Sequence[Path], patience: float
) -> Iterator[dict[str, Any]]:
    """Run pytest, and yield the lines it writes as they come."""
    empty = folder / "empty"
    empty.mkdir()
    with (folder / "said").open("wb") as said:
        streams: dict[str, Any] = {"stdin": subprocess.DEVNULL, "stdout": said, "stderr": said}
        words = _command(job, empty, files)
        process = subprocess.Popen(words, cwd=empty, env=_environment(folder), **streams)
        try:
            yield from _followed(process, folder / "lines", patience)
        finally:
            ended = process.poll()  # None: its time is over, or nobody listens any more
            process.kill()
            process.wait()
    if ended is not None and ended < 0:
        raise InputError(f"the checks were ended from outside, by signal {-ended}")
    if ended not in (None, 0, 1):  # 1: some checks do not hold
        told = (folder / "said").read_text(errors="replace").strip().splitlines()
        raise InputError("the checks could not be run: " + " / ".join(told[-4:]))


def _followed(
    process: "subprocess.Popen[bytes]", file: Path, patience: float
) -> Iterator[dict[str, Any]]:
    end, rest = time.monotonic() + patience, ""
    with file.open(encoding="utf8") as lines:
        while True:
            ended = process.poll() is not None  # asked before reading: nothing comes after
            *whole, rest = (rest + lines.read()).split("\n")
            yield from map(json.loads, whole)
            if ended or time.monotonic() > end:
                return
            time.sleep(TICK)


def _command(job: Path, empty: Path, files: Sequence[Path]) -> list[str]:
    """Return the command: no configuration, no plugin and no conftest of this machine has a say."""
    options = [
        *("-q", "-q", "--noconftest", "--import-mode=importlib"),
        *(f"--rootdir={empty}", f"--confcutdir={empty}"),
        *(
            "-c",
            os.devnull,
            "-p",
            "no:cacheprovider",
            "-p",
            "hdrlab.course.checks.plugin",
            "-W",
            "ignore",
        ),
        *("-o", f"pythonpath={SPECIFICATION}", "--tb=native", f"--job={job}"),
    ]
    return [sys.executable, "-P", "-m", "pytest", *options, *map(str, files)]


def _environment(folder: Path) -> dict[str, str]:
    """Return this process's environment but for what could change a score; its scratch is in the folder."""
    kept = {name: value for name, value in os.environ.items() if name not in UNWANTED}
    set_to_1 = ("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "PYTHONDONTWRITEBYTECODE", "OPENBLAS_NUM_THREADS")
    return (
        kept | dict.fromkeys(set_to_1, "1") | {"PYTHONPATH": import_path(), "TMPDIR": str(folder)}
    )
