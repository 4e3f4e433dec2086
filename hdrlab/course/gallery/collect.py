"""Read the artifacts that students hand in: images, and archives of `hdrlab submit`.

The name of the file, or of the folder that holds it, says whose artifact it is, as for all
submissions. What an archive's manifest says does not count, for anybody can write it. An image
`team7.jpg` may have a text `team7.txt` beside it: the title in its first line, then a caption.
"""

import hashlib
import hmac
import json
import sqlite3
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from hdrlab.course.gallery import pictures, store
from hdrlab.course.gallery.agreement import score
from hdrlab.course.projects.project import MANIFEST_FILE, find_map
from hdrlab.course.sanitize import sanitize_line
from hdrlab.course.students.roster import Roster
from hdrlab.course.submissions.archives import unpack
from hdrlab.errors import InputError

MAX_TITLE_CHARACTERS = 60
MAX_CAPTION_CHARACTERS = 280
# of an image's text file
MAX_TEXT_CHARACTERS = 1_000_000
MAX_MANIFEST_BYTES = 1_000_000
MAX_MAP_BYTES = 256_000_000
ID_CHARACTERS = 24
ARCHIVE_SUFFIXES = (".zip", ".tar", ".tar.gz", ".tgz", ".tar.bz2", ".tar.xz")
IGNORED_SUFFIXES = (".txt", ".csv")


@dataclass(frozen=True)
class Entry:
    """An artifact that a team hands in, with the paths of its image and, if it has one, its map."""

    team: str
    title: str
    caption: str
    picture: Path
    radiance_map: Path | None = None


def sources(paths: Sequence[Path]) -> list[tuple[Path, str]]:
    """Return the images and archives in files and folders, each with the name that says whose it is.

    In a folder, that name is the one of a file or of a subfolder.
    """
    named_files = []
    for path in paths:
        for item in sorted(path.iterdir()) if path.is_dir() else [path]:
            is_folder = item.is_dir() and not item.is_symlink()
            files = sorted(item.iterdir()) if is_folder else [item]
            named_files += [(file, item.name) for file in files]
    return [
        (file, name)
        for file, name in named_files
        if file.suffix.lower() not in IGNORED_SUFFIXES and not file.name.startswith(".")
    ]


@contextmanager
def entry(source: Path, roster: Roster, name: str = "") -> Iterator[Entry]:
    """Yield the Entry of an image or an archive; an archive is unpacked until the block ends.

    Parameters
    ----------
    source : the file
    roster : the class
    name : the name that says whose it is; by default the file's own

    Raises
    ------
    InputError
        For a name that is nobody's, for what is no plain file, and for an archive that is rejected
        or has no manifest or artifact.
    """
    team = roster.owner(name or source.name)
    if team is None:
        raise InputError(
            "expected a file or a folder that is named after a student or a team of the roster"
        )
    if source.is_symlink() or not source.is_file():
        raise InputError("expected a plain file, got a link, a pipe or a device")
    if not source.name.lower().endswith(ARCHIVE_SUFFIXES):
        yield _image_entry(source, team)
        return
    with tempfile.TemporaryDirectory(prefix="hdrlab-") as scratch:
        folder = Path(scratch) / "submission"
        unpack.unpack(source, folder)
        yield _archive_entry(folder, team)


def hang(db: sqlite3.Connection, folder: Path, new: Entry, source: str = "") -> int:
    """Add an artifact to the wall in place of the team's earlier one.

    Parameters
    ----------
    db : connection to the gallery's database
    folder : folder of the gallery
    new : the artifact
    source : name of the file that was handed in, for the list of changes

    Returns
    -------
    int
        The number of votes of the earlier artifact, which do not count any more.
    """
    prepared = pictures.prepare(new.picture)
    # the id depends on the gallery's secret, so that nobody can guess another image's address
    keyed_hash = hmac.new(store.settings(db).secret, new.team.encode() + b"\0", hashlib.sha256)
    keyed_hash.update(prepared.files["large"])
    id = keyed_hash.hexdigest()[:ID_CHARACTERS]
    pictures.keep(folder / store.PICTURES, id, prepared)
    artifact = store.Artifact(
        id=id,
        team=new.team,
        title=new.title,
        caption=new.caption,
        width=prepared.width,
        height=prepared.height,
    )
    with store.transaction(db):
        return store.hang(db, artifact, sanitize_line(source, 80))


def score_entry(db: sqlite3.Connection, new: Entry, radiance_map: Path | None = None) -> bool:
    """Store TMQI and PU-SSIM of an artifact on the wall, if it has a radiance map; return whether.

    Parameters
    ----------
    db : connection to the gallery's database
    new : the artifact, after `hang`
    radiance_map : the map of an artifact that has none of its own

    Raises
    ------
    InputError
        For a map that cannot be read, is too large, has no light, or does not fit the artifact.
    """
    path = new.radiance_map or radiance_map
    if path is None:
        return False
    if path.stat().st_size > MAX_MAP_BYTES:
        raise InputError(f"{path.name}: expected a radiance map of at most {MAX_MAP_BYTES} bytes")
    scores = score(new.picture, path)
    insert = (
        "INSERT INTO scores SELECT id, ?, ? FROM artifacts WHERE hangs AND team = ? "
        "ON CONFLICT (artifact) DO UPDATE SET tmqi = excluded.tmqi, pu_ssim = excluded.pu_ssim"
    )
    with store.transaction(db):
        db.execute(insert, (scores.tmqi, scores.pu_ssim, new.team))
    return True


def _image_entry(source: Path, team: str) -> Entry:
    """Return the Entry of an image, with the title and caption of the text file beside it."""
    text_file = source.with_suffix(".txt")
    text = ""
    if text_file.is_file() and not text_file.is_symlink():
        with text_file.open(encoding="utf8", errors="replace") as file:
            text = file.read(MAX_TEXT_CHARACTERS)
    title, _, caption = text.strip().partition("\n")
    return _make_entry(team, title, caption, source)


def _archive_entry(folder: Path, team: str) -> Entry:
    """Return the Entry of an unpacked archive."""
    manifest = folder / MANIFEST_FILE
    if not manifest.is_file() or manifest.stat().st_size > MAX_MANIFEST_BYTES:
        raise InputError(f"expected an archive of `hdrlab submit`, it has no {MANIFEST_FILE}")
    try:
        content: Any = json.loads(manifest.read_text(encoding="utf8"))
        title = str(content["title"])
        caption = str(content["caption"])
        artifact = str(content["artifact"])
    # what JSON of another form than a manifest's raises
    except (ValueError, KeyError, TypeError, RecursionError):
        raise InputError(
            f"expected an archive of `hdrlab submit`, its {MANIFEST_FILE} is damaged"
        ) from None
    # the artifact's name is looked up, and never joined to a path
    path_of_name = {
        path.relative_to(folder).as_posix(): path for path in folder.rglob("*") if path.is_file()
    }
    if artifact not in path_of_name:
        raise InputError(
            f"expected an artifact in the archive, got the name {sanitize_line(artifact, 40)!r}"
        )
    entry = _make_entry(team, title, caption, path_of_name[artifact])
    files = [path for path in path_of_name.values() if path.parent == folder]
    return replace(entry, radiance_map=find_map(sorted(files)))


def _make_entry(team: str, title: str, caption: str, picture: Path) -> Entry:
    """Return an Entry with a title and a caption that are safe to show and short enough."""
    return Entry(
        team=team,
        title=sanitize_line(title, MAX_TITLE_CHARACTERS) or "Untitled",
        caption=sanitize_line(caption, MAX_CAPTION_CHARACTERS),
        picture=picture,
    )
