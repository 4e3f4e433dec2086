"""A project is handed in: its files, its pictures cleaned, in one archive with a description."""

import hashlib
import json
import zipfile
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

import hdrlab
from hdrlab.course.archives.packing import packed
from hdrlab.course.projects import privacy
from hdrlab.course.projects.project import MANIFEST, Project
from hdrlab.errors import InputError
from hdrlab.io.files import write as save

VERSION = 1


class Packed(NamedTuple):
    """A file as it goes into the archive, what was left out of it, and what it may still tell."""

    name: str
    data: bytes
    removed: frozenset[str] = frozenset()
    remains: str = ""


def pack(project: Project, *, keep: bool = False) -> Iterator[Packed]:
    """Yield every file of a project, pictures without location and serial numbers unless those are kept.

    Raises
    ------
    ValueError
        For a picture that cannot be cleaned.
    """
    for path in project.files:
        data, name = path.read_bytes(), project.name(path)
        suffix = path.suffix.lower()
        if keep or not (suffix in privacy.PICTURES or path in project.photographs):
            yield Packed(name, data)
        else:
            yield Packed(name, *privacy.clean(name, data))


def write(
    project: Project, archive: Path, files: list[Packed], *, now: datetime | None = None
) -> str:
    """Write the archive of a project, with a description of it, and return its digest.

    Parameters
    ----------
    project : Project
    archive : the .zip; what it held is replaced
    files : what `pack` yields
    now : the time of handing in that the description states; the course goes by the time of arrival

    Raises
    ------
    ValueError
        For a project without an artifact.
    """
    if project.artifact is None:
        raise InputError("expected an artifact, there is none")
    described = {
        "version": VERSION,
        "made": (now or datetime.now(UTC)).isoformat(timespec="seconds"),
        "hdrlab": hdrlab.__version__,
        **project.about._asdict(),
        "artifact": project.name(project.artifact),
        "map": project.name(project.map) if project.map else None,
        "photographs": [project.name(path) for path in project.photographs],
        "files": {one.name: hashlib.sha256(one.data).hexdigest() for one in files},
    }
    manifest = (json.dumps(described, indent=1, ensure_ascii=False) + "\n").encode()
    data = packed({MANIFEST: manifest, **{one.name: one.data for one in files}})
    save(archive, data)
    return hashlib.sha256(data).hexdigest()


def is_archive(path: Path) -> bool:
    """Return whether a file is an archive that `write` has made."""
    if not zipfile.is_zipfile(path):
        return False
    with zipfile.ZipFile(path) as opened:
        return MANIFEST in opened.namelist()
