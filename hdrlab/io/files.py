"""Write files completely or not at all, and check what headers claim before using it."""

import errno
import os
from collections.abc import Collection, Iterable, Iterator
from contextlib import contextmanager
from itertools import combinations, product
from pathlib import Path
from typing import BinaryIO

from hdrlab.errors import FileFormatError, InputError
from hdrlab.io.temporary import temporary_file

# Beyond any camera, and 1.6 GB as float32 RGB.
MAX_PIXELS = 2**27

# Why a photo for print cannot be a frame of a bracket.
CMYK_REASON = (
    "this photo is CMYK, for print, and its values do not tell how much light there was; "
    "export it as RGB from the original photo"
)


class OtherPixels(InputError):
    """An image that cannot be a frame of a bracket: with a palette, of CMYK, of floats, ..."""


@contextmanager
def replacing(path: str | Path, *, private: bool = False) -> Iterator[Path]:
    """Yield a temporary name next to `path`, which replaces `path` when the block succeeds.

    If the block fails or is interrupted, the temporary file is removed and `path` stays as it was.
    Nobody but its owner can read a private file, from the first byte on.

    Raises
    ------
    FileNotFoundError, InputError
        See `require_replaceable`.

    Examples
    --------
    >>> import tempfile
    >>> target = Path(tempfile.mkdtemp()) / "note.txt"
    >>> with replacing(target) as name:
    ...     _ = name.write_text("all of it")
    >>> target.read_text()
    'all of it'
    """
    path = require_replaceable(path)
    # Codecs choose the format by the suffix.
    with temporary_file(path.parent, path.suffix, private=private, target=path) as temporary:
        yield temporary


def write(path: str | Path, content: str | bytes, *, private: bool = False) -> Path:
    r"""Write a file completely or not at all, and return its path.

    Parameters
    ----------
    path
        The file; its folder must exist.
    content
        Bytes, or text, which is written in UTF-8; a lone surrogate becomes a "?".
    private
        Whether nobody but its owner can read the file, from the first byte on.

    Raises
    ------
    FileNotFoundError
        Where the folder of `path` does not exist.
    InputError
        Where `path` is a folder or a device, which cannot be replaced.

    Examples
    --------
    >>> import tempfile
    >>> write(Path(tempfile.mkdtemp()) / "note.txt", "half a character: \ud83d").read_text("utf8")
    'half a character: ?'
    """
    with replacing(path, private=private) as temporary:
        temporary.write_bytes(
            content.encode("utf8", "replace") if isinstance(content, str) else content
        )
    return Path(path)


def require_replaceable(path: str | Path) -> Path:
    """Return the absolute path of a file to write, or raise an error if it cannot be written.

    A link is followed, so that its target is replaced and not the link.

    Raises
    ------
    FileNotFoundError
        Where the folder of `path` does not exist.
    InputError
        Where `path` is a folder or a device, which cannot be replaced.
    """
    path = Path(path).resolve()
    if not path.parent.is_dir():
        raise FileNotFoundError(f"cannot write {path.name}: there is no folder {path.parent}")
    if path.exists() and not path.is_file():
        raise InputError(
            f"cannot write {path}: expected the name of a file, this is a folder or a device"
        )
    return path


def require_suffix(path: str | Path, known: Collection[str], what: str) -> str:
    """Return the suffix of a file's name in lower case, or raise an InputError if it is unknown."""
    suffix = Path(path).suffix.lower()
    if suffix not in known:
        raise InputError(
            f"{path}: expected {what} ({', '.join(known)}), got {suffix or 'no suffix'}"
        )
    return suffix


def require_no_folder(path: str | Path, what: str) -> None:
    """Raise a FileFormatError if `path` is a folder where `what`, such as "a photo", is needed.

    A path that does not exist passes: opening it raises FileNotFoundError.
    """
    if Path(path).is_dir():
        raise FileFormatError(f"{path}: this is a folder, not {what}; pass the name of a file")


def require_folder_name(path: str | Path) -> None:
    """Raise an InputError if `path` is a file where a folder to write to is needed."""
    path = Path(path)
    if path.exists() and not path.is_dir():
        raise InputError(f"{path}: expected the name of a folder, this is a file")


def require_other(written: Iterable[Path], read: Iterable[Path]) -> None:
    """Raise an InputError if a file to be written is also read, under whatever name.

    A link names the same file, and so does another spelling on a disk that ignores case.
    """
    inputs = [path for path in read if os.path.exists(path)]
    for path, source in product(filter(os.path.exists, written), inputs):
        if os.path.samefile(path, source):
            raise InputError(
                f"{path}: writing would overwrite the input {source}; pass another name"
            )


def require_distinct(written: Iterable[Path]) -> None:
    """Raise an InputError if two files to be written are one file, under whatever names."""
    for first, second in combinations(written, 2):
        is_same_name = os.path.realpath(first) == os.path.realpath(second)
        if is_same_name or _is_same_file(first, second):
            raise InputError(f"two outputs have the same name, {second}; pass another name for one")


def _is_same_file(first: Path, second: Path) -> bool:
    if not (os.path.exists(first) and os.path.exists(second)):
        return False
    return os.path.samefile(first, second)


def reserve(file: BinaryIO, size: int) -> None:
    """Reserve `size` bytes on the disk, which finds a full disk early and is quicker.

    Does nothing on systems without posix_fallocate.
    """
    if hasattr(os, "posix_fallocate"):
        try:
            os.posix_fallocate(file.fileno(), 0, size)
        except OSError as error:
            if error.errno == errno.ENOSPC:
                raise


def check_size(
    path: str | Path, height: int, width: int, least: int = 0, *, available: int | None = None
) -> None:
    """Raise a FileFormatError if a header claims an absurd size, before memory is allocated.

    `least` is the number of bytes that such an image takes at the format's best compression, and
    `available` the number that the file has for it, by default all its bytes.
    """
    claim = f"{path}: its header claims {width} x {height} pixels"
    if height < 1 or width < 1:
        raise FileFormatError(f"{claim}, expected at least one")
    if height * width > MAX_PIXELS:
        raise FileFormatError(f"{claim}, expected at most {MAX_PIXELS} in all")
    size = Path(path).stat().st_size if available is None else available
    if size < least:
        raise FileFormatError(
            f"{claim}, which need {least} bytes or more, but has {size}: it is cut short or damaged"
        )
