"""A temporary folder for all that a command writes, and locks between processes."""

import contextlib
import tempfile
from collections.abc import Iterator
from pathlib import Path

import filelock

from hdrlab.io import temporary


@contextlib.contextmanager
def temporary_folder() -> Iterator[Path]:
    """Create a folder, and use it for all temporary files of this process.

    A command that was killed cannot delete its folder; the next command does.

    Examples
    --------
    >>> with temporary_folder() as folder:
    ...     tempfile.gettempdir() == str(folder)
    True
    >>> folder.exists()
    False
    """
    with locked_folder() as folder:
        previous = tempfile.tempdir
        tempfile.tempdir = str(folder)
        try:
            yield folder
        finally:
            tempfile.tempdir = previous


@contextlib.contextmanager
def locked_folder() -> Iterator[Path]:
    """Create a new folder, lock it, and delete the folders that killed processes have left."""
    parent = Path(tempfile.gettempdir())
    temporary.remove_leftovers(parent)
    with temporary.temporary_folder(parent) as folder:
        yield folder


@contextlib.contextmanager
def locked(path: Path) -> Iterator[None]:
    """Hold a lock file, which is created if it does not exist.

    Raises
    ------
    BlockingIOError
        If another process holds it.
    """
    lock = filelock.FileLock(path, timeout=0, mode=0o600)
    try:
        lock.acquire()
    except filelock.Timeout:
        raise BlockingIOError(f"{path} is locked by another process") from None
    try:
        yield
    finally:
        lock.release()
