"""Archives given as bytes, unpacked with limits: what is in them, or in which words they are refused."""

import pytest

from hdrlab.course.submissions.archives.members import ArchiveLimits, ArchiveRejected
from hdrlab.course.submissions.archives.unpack import unpack

TOLD = "it is damaged"


def taken(folder, data, **limits):
    """Return what is unpacked of an archive, by name; where that fails, nothing is left behind."""
    archive, target = folder / "archive", folder / f"new{len(list(folder.iterdir()))}"
    archive.write_bytes(data)
    try:
        found = unpack(archive, target, ArchiveLimits(**limits))
    except (ArchiveRejected, OSError):
        assert not target.exists() and not list(folder.glob(".hdrlab-*"))
        raise
    written = {str(path): (target / path).read_bytes() for path, _ in found}
    assert [size for _, size in found] == [len(held) for held in written.values()]
    assert len([one for one in target.rglob("*") if one.is_file()]) == len(written)
    return written


def refused(taken, data, **limits):
    """Return in which words an archive is refused."""
    with pytest.raises(ArchiveRejected) as raised:
        taken(data, **limits)
    return str(raised.value)
