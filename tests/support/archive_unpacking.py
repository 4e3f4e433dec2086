"""Unpack archives that a test gives as bytes, and check that a rejected archive leaves no files."""

import pytest

from hdrlab.course.submissions.archives.members import ArchiveLimits, ArchiveRejected
from hdrlab.course.submissions.archives.unpack import unpack

DAMAGED_MESSAGE = "it is damaged"


def unpack_bytes(folder, data, **limits):
    """Unpack an archive into a new folder and return its files.

    Parameters
    ----------
    folder : the folder of the test
    data : the bytes of the archive
    limits : fields of ArchiveLimits

    Returns
    -------
    dict : the bytes of each file, by its path inside the archive

    Raises
    ------
    ArchiveRejected, OSError
        If the archive cannot be unpacked. The function checks that no file is left.
    """
    archive = folder / "archive"
    target = folder / f"new{len(list(folder.iterdir()))}"
    archive.write_bytes(data)
    try:
        members = unpack(archive, target, ArchiveLimits(**limits))
    except (ArchiveRejected, OSError):
        assert not target.exists()
        assert not list(folder.glob(".hdrlab-*"))
        raise
    contents = {str(path): (target / path).read_bytes() for path, _ in members}
    assert [size for _, size in members] == [len(content) for content in contents.values()]
    files = [path for path in target.rglob("*") if path.is_file()]
    assert len(files) == len(contents)
    return contents


def rejection_message(unpack_archive, data, **limits):
    """Return the message of the ArchiveRejected that `unpack_archive(data, **limits)` raises."""
    with pytest.raises(ArchiveRejected) as raised:
        unpack_archive(data, **limits)
    return str(raised.value)
