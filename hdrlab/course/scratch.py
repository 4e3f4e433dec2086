"""A folder for all that a command writes on its way, which is gone when it ends, however it ended.

A command that was killed cannot clear up. So its folder is locked as long as it lives, and the next
one removes the folders that nobody holds any more.
"""

import contextlib
import os
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

from hdrlab.course.sandbox.inside import system

PREFIX = "hdrlab-run-"


@contextlib.contextmanager
def temporary_folder() -> Iterator[Path]:
    """Make a folder in which this process writes all that is temporary.

    Examples
    --------
    >>> with temporary_folder() as folder:
    ...     tempfile.gettempdir() == str(folder)
    True
    >>> folder.exists()
    False
    """
    with locked_folder() as folder:
        before, tempfile.tempdir = tempfile.tempdir, str(folder)
        try:
            yield folder
        finally:
            tempfile.tempdir = before


@contextlib.contextmanager
def locked_folder() -> Iterator[Path]:
    """Make a new folder, and remove those that killed processes have left."""
    for old in Path(tempfile.gettempdir()).glob(f"{PREFIX}*") if os.name == "posix" else ():
        with contextlib.suppress(OSError), locked(old):
            shutil.rmtree(old, ignore_errors=True)
    with contextlib.ExitStack() as stack:
        name = ""
        while not os.path.exists(name):  # another may have removed it before it was locked
            made = tempfile.TemporaryDirectory(prefix=PREFIX, ignore_cleanup_errors=True)
            name = stack.enter_context(made)
            with contextlib.suppress(FileNotFoundError):
                stack.enter_context(locked(Path(name), wait=True))
        yield Path(name)


@contextlib.contextmanager
def locked(folder: Path, *, wait: bool = False) -> Iterator[None]:
    """Lock a folder, or raise a BlockingIOError where another process holds it."""
    if system.fcntl is None:  # on Windows, where nothing is locked
        yield
        return
    handle = os.open(folder, os.O_RDONLY | os.O_NOFOLLOW | os.O_DIRECTORY)
    try:
        system.lock(handle, wait)
        yield
    finally:
        os.close(handle)
