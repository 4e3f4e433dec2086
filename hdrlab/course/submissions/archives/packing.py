"""Archives that are written: the same files give the same bytes."""

import io
import zipfile
from collections.abc import Collection, Mapping
from pathlib import PurePath

EPOCH = (1980, 1, 1, 0, 0, 0)  # the time of every file
PACKED = {
    ".jpg",
    ".jpeg",
    ".png",
    ".zip",
    ".gz",
    ".webp",
    ".exr",
}  # which another compression only slows


def packed(files: Mapping[str, bytes], programs: Collection[str] = ()) -> bytes:
    """Return the bytes of a zip of these files by name, of which `programs` can be run.

    Examples
    --------
    >>> zipfile.ZipFile(io.BytesIO(packed({"b.txt": b"2", "a.txt": b"1"}))).namelist()
    ['a.txt', 'b.txt']
    """
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w") as opened:
        for name, data in sorted(files.items()):
            entry = zipfile.ZipInfo(name, EPOCH)
            entry.external_attr = (0o100755 if name in programs else 0o100644) << 16
            stored = PurePath(name).suffix.lower() in PACKED
            opened.writestr(entry, data, zipfile.ZIP_STORED if stored else zipfile.ZIP_DEFLATED)
    return archive.getvalue()
