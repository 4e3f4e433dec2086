"""Pack a project into one archive for submission; its photos go without personal metadata."""

import hashlib
import json
import zipfile
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path

import hdrlab
from hdrlab.course.projects.project import MANIFEST_FILE, Project
from hdrlab.course.submissions.archives.packing import make_zip
from hdrlab.errors import InputError
from hdrlab.io import album, files, metadata

MANIFEST_VERSION = 1
# Media and side-car files that hdrlab does not read; they may contain a location.
OTHER_MEDIA_SUFFIXES = frozenset(
    {".gif", ".bmp", ".jp2", ".psd", ".pdf", ".xmp", ".mp4", ".mov", ".m4v", ".avi", ".webm"}
)


@dataclass(frozen=True)
class PackedFile:
    """A file as it goes into the archive; what was removed from it, and what may remain."""

    name: str
    data: bytes
    removed: frozenset[str] = frozenset()
    remaining: str = ""


def pack(project: Project, *, keep: bool = False) -> Iterator[PackedFile]:
    """Yield every file of a project, all its photos without personal metadata.

    Parameters
    ----------
    project
        The project.
    keep
        Whether photos keep their metadata.

    Raises
    ------
    FileFormatError
        For a photo whose metadata hdrlab cannot remove.
    """
    for path in project.files:
        name = project.name(path)
        data = path.read_bytes()
        suffix = path.suffix.lower()
        if keep:
            yield PackedFile(name, data)
        elif suffix in album.SUFFIXES or metadata.is_photo(data):
            cleaned = metadata.strip_metadata(name, data)
            yield PackedFile(name, cleaned.data, cleaned.removed, cleaned.remaining)
        elif suffix in OTHER_MEDIA_SUFFIXES:
            warning = (
                f"hdrlab does not remove metadata from {suffix} files, check it for a location"
            )
            yield PackedFile(name, data, remaining=warning)
        else:
            yield PackedFile(name, data)


def write(
    project: Project,
    archive: Path,
    packed_files: list[PackedFile],
    *,
    now: datetime | None = None,
) -> str:
    """Write the archive of a project, with a manifest, and return the archive's SHA-256 digest.

    Parameters
    ----------
    project
        The project.
    archive
        The .zip file; an existing one is replaced.
    packed_files
        What `pack` yields.
    now
        The time that the manifest states. The course goes by the time of arrival.

    Raises
    ------
    InputError
        For a project without an artifact.
    """
    if project.artifact is None:
        raise InputError("there is no artifact; save your best tone-mapped image as artifact.jpg")
    digests = {file.name: hashlib.sha256(file.data).hexdigest() for file in packed_files}
    manifest = {
        "version": MANIFEST_VERSION,
        "made": (now or datetime.now(UTC)).isoformat(timespec="seconds"),
        "hdrlab": hdrlab.__version__,
        **asdict(project.about),
        "artifact": project.name(project.artifact),
        "map": project.name(project.map) if project.map else None,
        "photographs": [project.name(path) for path in project.photographs],
        "files": digests,
    }
    manifest_text = json.dumps(manifest, indent=1, ensure_ascii=False) + "\n"
    members = {MANIFEST_FILE: manifest_text.encode()}
    for file in packed_files:
        members[file.name] = file.data
    data = make_zip(members)
    files.write(archive, data)
    return hashlib.sha256(data).hexdigest()


def is_archive(path: Path) -> bool:
    """Return whether a file is an archive that `hdrlab submit` has written."""
    if not zipfile.is_zipfile(path):
        return False
    with zipfile.ZipFile(path) as opened:
        return MANIFEST_FILE in opened.namelist()
