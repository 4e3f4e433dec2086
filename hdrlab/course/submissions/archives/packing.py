"""Write zip archives: the same files always give the same bytes."""

import io
import zipfile
from collections.abc import Collection, Mapping
from pathlib import PurePath

# the time of every file: the earliest that a zip archive can hold
FILE_TIME = (1980, 1, 1, 0, 0, 0)
# formats that are compressed already, so that compressing them again only takes time
COMPRESSED_SUFFIXES = {".jpg", ".jpeg", ".png", ".zip", ".gz", ".webp", ".exr"}
REGULAR_FILE_MODE = 0o100644
EXECUTABLE_FILE_MODE = 0o100755
# a zip entry keeps the Unix mode in the upper half of its attributes
MODE_SHIFT = 16


def make_zip(files: Mapping[str, bytes], executables: Collection[str] = ()) -> bytes:
    """Return the bytes of a zip archive.

    Parameters
    ----------
    files : mapping
        The content of the files, by name.
    executables : collection of str
        Names of the files that are executable.

    Examples
    --------
    >>> zipfile.ZipFile(io.BytesIO(make_zip({"b.txt": b"2", "a.txt": b"1"}))).namelist()
    ['a.txt', 'b.txt']
    """
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w") as zip_file:
        for name, data in sorted(files.items()):
            entry = zipfile.ZipInfo(name, FILE_TIME)
            mode = EXECUTABLE_FILE_MODE if name in executables else REGULAR_FILE_MODE
            entry.external_attr = mode << MODE_SHIFT
            is_compressed = PurePath(name).suffix.lower() in COMPRESSED_SUFFIXES
            method = zipfile.ZIP_STORED if is_compressed else zipfile.ZIP_DEFLATED
            zip_file.writestr(entry, data, method)
    return archive.getvalue()
