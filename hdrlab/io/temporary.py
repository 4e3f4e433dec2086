"""Temporary files and folders, and the removal of those that a killed process has left.

Their names begin with `.hdrlab-` and 12 random digits. The process that makes one locks it until it
is renamed or removed. The operating system releases the locks of a process that ends, however it
ends. So what nobody locks is a leftover, and the next command that writes to the folder removes it.
"""

import errno
import os
import re
import secrets
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache, partial
from pathlib import Path

try:
    import fcntl
except ImportError:  # Windows, and Python in a browser
    fcntl = None  # type: ignore[assignment]

NAME = re.compile(r"\.hdrlab-[0-9a-f]{12}(\..*)?")
# Locked while the temporary folder of the same name is in use.
LOCK_SUFFIX = ".lock"
FILE_MODE = 0o666  # less the process's umask
PRIVATE_FILE_MODE = 0o600
FOLDER_MODE = 0o700
# A disk with less room counts as full: what was being written did not fit.
FULL_DISK_BYTES = 64 * 2**10


@contextmanager
def temporary_file(
    folder: Path, suffix: str = "", *, private: bool = False, target: Path | None = None
) -> Iterator[Path]:
    """Create an empty file, lock it, and remove it at the end, unless it becomes `target`.

    Parameters
    ----------
    folder
        Where the file is; leftovers in this folder are removed first.
    suffix
        The suffix of its name, by which codecs choose the format.
    private
        Whether nobody but its owner can read the file.
    target
        The file that it replaces if the block succeeds. It is in the same folder.

    Examples
    --------
    >>> import tempfile
    >>> folder = Path(tempfile.mkdtemp())
    >>> with temporary_file(folder, ".txt", target=folder / "note.txt") as path:
    ...     _ = path.write_text("all of it")
    >>> [path.name for path in folder.iterdir()]
    ['note.txt']
    """
    _remove_leftovers_once(folder)
    mode = PRIVATE_FILE_MODE if private else FILE_MODE
    handle = None
    with _name_in_errors(target or folder):
        while handle is None:
            path = folder / f".hdrlab-{secrets.token_hex(6)}{suffix}"
            handle = _create_locked(path, mode)
    try:
        with _name_in_errors(target or folder):
            yield path
            if target is not None:
                if os.name == "nt":  # Windows does not rename a file that is open
                    os.close(handle)
                    handle = None
                os.replace(path, target)
    finally:
        # Windows does not remove a file that is open; elsewhere a file without a lock is a leftover
        if handle is not None and os.name == "nt":
            os.close(handle)
            handle = None
        _call_despite_interrupt(partial(path.unlink, missing_ok=True))
        if handle is not None:
            os.close(handle)


@contextmanager
def temporary_folder(parent: Path, *, target: Path | None = None) -> Iterator[Path]:
    """Create a folder that only its owner can open, and remove it at the end.

    Its lock is a temporary file beside it, so the lock exists before the folder does.

    Parameters
    ----------
    parent
        Where the folder is; leftovers there are removed first.
    target
        What is made in the folder. Errors name it, and not the temporary folder.

    Examples
    --------
    >>> import tempfile
    >>> with temporary_folder(Path(tempfile.mkdtemp())) as folder:
    ...     folder.is_dir()
    True
    >>> folder.exists()
    False
    """
    with temporary_file(parent, LOCK_SUFFIX) as lock:
        folder = lock.with_suffix("")
        try:
            with _name_in_errors(target or parent):
                folder.mkdir(mode=FOLDER_MODE)
                yield folder
        finally:
            _call_despite_interrupt(partial(shutil.rmtree, folder, ignore_errors=True))


@contextmanager
def _name_in_errors(target: Path) -> Iterator[None]:
    """Turn errors of writing into an OSError that names the file of the user, and says why it failed."""
    try:
        yield
    except Exception as error:
        # Some codecs raise errors of their own where the disk is full.
        if not isinstance(error, ValueError) and is_disk_full(target.parent):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(target)) from None
        if not isinstance(error, OSError):
            raise
        if error.errno is None:
            # such as NumPy's for a short write: "817920 requested and 383940 written"
            reason = f"it could not be written completely ({error})"
            raise OSError(errno.EIO, reason, str(target)) from None
        if error.filename is None or _is_in_temporary(error.filename):
            raise OSError(error.errno, error.strerror, str(target)) from None
        raise


def is_disk_full(folder: Path) -> bool:
    """Return whether the disk of a folder has hardly any room left."""
    try:
        return shutil.disk_usage(folder).free < FULL_DISK_BYTES
    except OSError:  # the folder is gone
        return False


def _is_in_temporary(path: str | bytes) -> bool:
    return any(NAME.fullmatch(part) for part in Path(os.fsdecode(path)).parts)


def move_new(path: Path, target: Path) -> None:
    """Give a complete file its name, or raise FileExistsError if there is a file of this name.

    Another process may have made that file after the caller looked for it.
    """
    try:
        os.link(path, target)
    except FileExistsError:
        raise
    except OSError:  # a file system without hard links
        os.replace(path, target)


@contextmanager
def new_folder(folder: Path) -> Iterator[Path]:
    """Yield an empty temporary folder, which gets the name `folder` when the block succeeds.

    An empty folder of this name stays, because it may be the working folder of a process.
    """
    with temporary_folder(folder.parent, target=folder) as scratch:
        unfinished = scratch / folder.name
        unfinished.mkdir()
        yield unfinished
        if folder.exists():
            for path in unfinished.iterdir():
                path.replace(folder / path.name)
        else:
            unfinished.replace(folder)


def remove_leftovers(folder: Path, *, recursive: bool = False) -> None:
    """Remove the temporary files and folders of processes that have ended.

    What cannot be removed, such as the file of another user, stays where it is.

    Parameters
    ----------
    folder
        The folder that they are in; it need not exist.
    recursive
        Whether to look in its subfolders too.
    """
    try:
        entries = list(os.scandir(folder))
    except OSError:
        return
    for entry in entries:
        path = Path(entry.path)
        with suppress(OSError):
            if entry.is_dir(follow_symlinks=False):
                if recursive:
                    remove_leftovers(path, recursive=True)
            elif NAME.fullmatch(entry.name) and entry.is_file(follow_symlinks=False):
                _remove_if_unlocked(path)


def _call_despite_interrupt(remove: Callable[[], object]) -> None:
    """Call a function that removes something, and again if Ctrl-C interrupts it."""
    try:
        remove()
    except KeyboardInterrupt:
        remove()
        raise


# Not again for each of a thousand files in one folder.
@cache
def _remove_leftovers_once(folder: Path) -> None:
    remove_leftovers(folder)


def _create_locked(path: Path, mode: int) -> int | None:
    """Create a file and return its locked handle, or None if it was taken for a leftover meanwhile."""
    handle = os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL, mode)
    if fcntl is None:
        return handle
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        if os.path.exists(path):
            return handle
    except BlockingIOError:  # a process that removes leftovers has just opened it
        pass
    except OSError:  # a file system without locks, on which no leftover is removed
        return handle
    os.close(handle)
    return None


def _remove_if_unlocked(path: Path) -> None:
    """Remove a temporary file, and the folder whose lock it is, unless a living process uses it."""
    if fcntl is None:
        if os.name == "nt":
            os.rename(path, path)  # fails while a process has the file open
            _remove(path)
        return
    handle = os.open(path, os.O_RDWR | os.O_NOFOLLOW | os.O_NONBLOCK)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        _remove(path)
    finally:
        os.close(handle)


def _remove(path: Path) -> None:
    if path.suffix == LOCK_SUFFIX:
        shutil.rmtree(path.with_suffix(""), ignore_errors=True)
    path.unlink(missing_ok=True)
