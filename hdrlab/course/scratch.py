"""A temporary folder for all that a command writes, and locks between processes.

The folder is deleted when the command ends. A command that was killed cannot delete it. So the
folder is locked while its command lives, and the next command deletes the folders that nobody
locks. The operating system releases the lock of a process that ends, however it ends.
"""

import contextlib
import secrets
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

import filelock

PREFIX = "hdrlab-run-"
LOCK_SUFFIX = ".lock"


@contextlib.contextmanager
def temporary_folder() -> Iterator[Path]:
    """Create a folder, and use it for all temporary files of this process.

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
    for lock_path in parent.glob(f"{PREFIX}*{LOCK_SUFFIX}"):
        _delete_if_abandoned(lock_path)
    folder = parent / f"{PREFIX}{secrets.token_hex(8)}"
    lock_path = _lock_path(folder)
    try:
        with locked(lock_path, wait=True):
            folder.mkdir(mode=0o700)
            try:
                yield folder
            finally:
                shutil.rmtree(folder, ignore_errors=True)
    finally:
        _unlink(lock_path)


def _lock_path(folder: Path) -> Path:
    """Return the lock file of a temporary folder.

    It is beside the folder, so that it can be locked before the folder exists.
    """
    return folder.with_name(folder.name + LOCK_SUFFIX)


def _delete_if_abandoned(lock_path: Path) -> None:
    """Delete a temporary folder and its lock file, unless a living process holds the lock."""
    folder = lock_path.with_name(lock_path.name.removesuffix(LOCK_SUFFIX))
    try:
        with locked(lock_path):
            shutil.rmtree(folder, ignore_errors=True)
    except OSError:  # locked, or the file of somebody else
        return
    _unlink(lock_path)


def _unlink(path: Path) -> None:
    """Delete a file; on Windows this fails while somebody has it open, and a later run deletes it."""
    with contextlib.suppress(OSError):
        path.unlink(missing_ok=True)


@contextlib.contextmanager
def locked(path: Path, *, wait: bool = False) -> Iterator[None]:
    """Hold a lock file, which is created if it does not exist.

    Raises
    ------
    BlockingIOError
        If another process holds it, unless `wait` is set.
    """
    lock = filelock.FileLock(path, timeout=-1 if wait else 0, mode=0o600)
    try:
        lock.acquire()
    except filelock.Timeout:
        raise BlockingIOError(f"{path} is locked by another process") from None
    try:
        yield
    finally:
        lock.release()
