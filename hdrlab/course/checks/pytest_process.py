"""Run the specification by pytest in a process of its own, and read the results as they come.

The student's code never runs in this process: the checks call it in a sandbox (see subject.py).
`run_pytest_here` does the same without a process, for the in-process tier.
"""

import contextlib
import io
import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hdrlab.course.checks import SPECIFICATION
from hdrlab.course.sandbox.subprocess_runner import import_path
from hdrlab.errors import InputError

if TYPE_CHECKING:
    import pytest

POLL_SECONDS = 0.02
# pytest's exit codes if all checks hold, and if some do not
COMPLETED_EXIT_CODES = (0, 1)
MAX_ERROR_LINES = 4
# with it, pytest loads no plugin that is installed beside it
NO_PLUGINS_VARIABLE = "PYTEST_DISABLE_PLUGIN_AUTOLOAD"
# variables that could change a score, or run other code in the process
REMOVED_VARIABLES = ("PYTEST_ADDOPTS", "PYTEST_PLUGINS", "PYTHONSTARTUP", "PYTHONINSPECT")


def run_pytest(
    folder: Path, job: Path, files: Sequence[Path], *, timeout: float
) -> Iterator[dict[str, Any]]:
    """Run checks, and yield the lines that the plugin writes as soon as it writes them.

    When the time is over, this ends the process; the lines until then count.

    Parameters
    ----------
    folder : Path
        A folder for this run, with the file "lines" that the plugin writes to.
    job : Path
        The file that tells the plugin what to check; see plugin.py.
    files : sequence of Path
        The files with the checks.
    timeout : float
        Seconds that the process may take.

    Raises
    ------
    InputError
        If something outside ended the process, or pytest could not run the checks.
    """
    empty_folder = folder / "empty"
    empty_folder.mkdir()
    output_path = folder / "output"
    with output_path.open("wb") as output:
        process = subprocess.Popen(
            _command(job, empty_folder, files),
            cwd=empty_folder,
            env=_environment(folder),
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=output,
        )
        try:
            yield from _read_lines(process, folder / "lines", timeout)
        finally:
            # None if the time is over, or the caller takes no more lines
            exit_code = process.poll()
            process.kill()
            process.wait()
    if exit_code is None or exit_code in COMPLETED_EXIT_CODES:
        return
    if exit_code < 0:
        raise InputError(f"the checks were ended from outside, by signal {-exit_code}")
    raise _run_error(output_path.read_text(errors="replace"))


def run_pytest_here(folder: Path, job: Path, files: Sequence[Path]) -> Iterator[dict[str, Any]]:
    """Run checks in this process, and yield the lines that the plugin wrote, after the last check.

    The parameters and errors are those of `run_pytest`.
    """
    import pytest  # slow to import, and needed only where checks run

    empty_folder = folder / "empty"
    empty_folder.mkdir()
    options = _options(job, empty_folder, files)
    # pytest would take the place of the file descriptors, which is impossible in a browser
    options += ["--capture=no", "-p", "no:faulthandler"]
    output = io.StringIO()
    with (
        _restored_process_state(),
        contextlib.redirect_stdout(output),
        contextlib.redirect_stderr(output),
    ):
        interrupts = _InterruptRecorder()
        exit_code = pytest.main(options, plugins=[interrupts])
    if interrupts.is_key_press:
        raise KeyboardInterrupt
    if exit_code not in COMPLETED_EXIT_CODES:
        raise _run_error(output.getvalue())
    for line in (folder / "lines").read_text(encoding="utf8").splitlines():
        yield json.loads(line)


class _InterruptRecorder:
    """A plugin that tells Ctrl-C from checks that cannot be imported: pytest calls both interrupts."""

    def __init__(self) -> None:
        self.is_key_press = False

    def pytest_keyboard_interrupt(self, excinfo: "pytest.ExceptionInfo[BaseException]") -> None:
        """Note what stopped the run. pytest calls this hook."""
        import pytest

        self.is_key_press = not isinstance(excinfo.value, pytest.Session.Interrupted)


@contextlib.contextmanager
def _restored_process_state() -> Iterator[None]:
    """Set the environment for checks in this process; restore it and the import path afterwards."""
    search_path = list(sys.path)
    variables = {name: os.environ.get(name) for name in (*REMOVED_VARIABLES, NO_PLUGINS_VARIABLE)}
    for name in REMOVED_VARIABLES:
        os.environ.pop(name, None)
    os.environ[NO_PLUGINS_VARIABLE] = "1"
    try:
        yield
    finally:
        sys.path[:] = search_path
        for name, value in variables.items():
            os.environ.pop(name, None)
            if value is not None:
                os.environ[name] = value


def _run_error(output: str) -> InputError:
    """Return the error for checks that pytest could not run, with the end of what it printed."""
    last_lines = " / ".join(output.strip().splitlines()[-MAX_ERROR_LINES:])
    return InputError(f"the checks could not be run: {last_lines}")


def _read_lines(
    process: "subprocess.Popen[bytes]", path: Path, timeout: float
) -> Iterator[dict[str, Any]]:
    """Yield the JSON objects that a process writes to a file, one a line, until it ends."""
    deadline = time.monotonic() + timeout
    # the start of a line whose end is not written yet
    incomplete_line = ""
    with path.open(encoding="utf8") as file:
        while True:
            # looked up before reading: a process that has ended writes nothing more
            has_ended = process.poll() is not None
            *lines, incomplete_line = (incomplete_line + file.read()).split("\n")
            for line in lines:
                yield json.loads(line)
            if has_ended or time.monotonic() > deadline:
                return
            time.sleep(POLL_SECONDS)


def _command(job: Path, empty_folder: Path, files: Sequence[Path]) -> list[str]:
    """Return the command that runs pytest on the checks."""
    return [sys.executable, "-P", "-m", "pytest", *_options(job, empty_folder, files)]


def _options(job: Path, empty_folder: Path, files: Sequence[Path]) -> list[str]:
    """Return pytest's arguments, with which it uses no configuration, plugin or conftest of this machine."""
    options = ["-q", "-q"]
    options += ["--noconftest", "--import-mode=importlib", "--tb=native"]
    options += [f"--rootdir={empty_folder}", f"--confcutdir={empty_folder}"]
    # an empty configuration file
    options += ["-c", os.devnull]
    options += ["-p", "no:cacheprovider"]
    options += ["-p", "hdrlab.course.checks.plugin"]
    options += ["-W", "ignore"]
    options += ["-o", f"pythonpath={SPECIFICATION}"]
    options += [f"--job={job}"]
    return [*options, *[str(file) for file in files]]


def _environment(folder: Path) -> dict[str, str]:
    """Return this process's environment without what could change a score."""
    environment = {
        name: value for name, value in os.environ.items() if name not in REMOVED_VARIABLES
    }
    environment[NO_PLUGINS_VARIABLE] = "1"
    environment["PYTHONDONTWRITEBYTECODE"] = "1"
    environment["OPENBLAS_NUM_THREADS"] = "1"
    environment["PYTHONPATH"] = import_path()
    environment["TMPDIR"] = str(folder)
    return environment
