"""What is to hang: pictures named after a team or a student, and archives that `hdrlab submit` has made.

Whose an artifact is, the name of its file says, or that of the folder it lies in, as with all that
is handed in: what stands in an archive's description is the word of whoever made it. A picture
`team7.jpg` may have a file `team7.txt` beside it: the title in its first line, then a caption.
"""

import hashlib
import hmac
import json
import sqlite3
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from hdrlab.course.gallery import pictures, store
from hdrlab.course.projects.project import MANIFEST_FILE
from hdrlab.course.sanitize import sanitize_line
from hdrlab.course.students.roster import Roster
from hdrlab.course.submissions.archives import unpack
from hdrlab.errors import InputError

# characters
TITLE = 60
CAPTION = 280
SMALL = 1_000_000  # bytes, or characters, of a text
ARCHIVES = (".zip", ".tar", ".tar.gz", ".tgz", ".tar.bz2", ".tar.xz")
NOT_THESE = (".txt", ".csv")


class Entry(NamedTuple):
    """An artifact that a team hands in."""

    team: str
    title: str
    caption: str
    picture: Path


def sources(paths: Sequence[Path]) -> list[tuple[Path, str]]:
    """Return the pictures and archives of files and folders, each with the name that says whose it is."""
    found = []
    for path in paths:
        for one in sorted(path.iterdir()) if path.is_dir() else [path]:
            inside = sorted(one.iterdir()) if one.is_dir() and not one.is_symlink() else [one]
            found += [(file, one.name) for file in inside]
    return [
        one for one in found if one[0].suffix.lower() not in NOT_THESE and one[0].name[0] != "."
    ]


@contextmanager
def entry(source: Path, roster: Roster, name: str = "") -> Iterator[Entry]:
    """Yield the Entry of a picture or an archive, which is unpacked meanwhile.

    Parameters
    ----------
    source, roster : the file, and the class
    name : says whose it is; the file's own unless told

    Raises
    ------
    ValueError
        For a name that is nobody's, what is no plain file, and an archive with a trap, without a
        description or an artifact.
    """
    team = roster.owner(name or source.name)
    if team is None:
        raise InputError(
            "expected a file or a folder that is named after a student or a team of the roster"
        )
    if source.is_symlink() or not source.is_file():
        raise InputError("expected a plain file, got a link, a pipe or a device")
    if not source.name.lower().endswith(ARCHIVES):
        yield _picture(source, team)
        return
    with tempfile.TemporaryDirectory(prefix="hdrlab-") as scratch:
        folder = Path(scratch) / "submission"
        unpack.unpack(source, folder)
        yield _archive(folder, team)


def hang(db: sqlite3.Connection, folder: Path, one: Entry, source: str = "") -> int:
    """Make an artifact's pictures, put it on the wall, and return how many votes the one before had."""
    prepared = pictures.prepare(one.picture)
    seal = hmac.new(store.settings(db).secret, one.team.encode() + b"\0", hashlib.sha256)
    seal.update(prepared.files["large"])
    id = seal.hexdigest()[:24]  # nobody can tell the address of another picture
    pictures.keep(folder / store.PICTURES, id, prepared)
    with store.transaction(db):
        made = store.Artifact(id, one.team, one.title, one.caption, prepared.width, prepared.height)
        return store.hang(db, made, sanitize_line(source, 80))


def _picture(source: Path, team: str) -> Entry:
    words = source.with_suffix(".txt")
    text = ""
    if words.is_file() and not words.is_symlink():
        with words.open(encoding="utf8", errors="replace") as file:
            text = file.read(SMALL)  # and no more of it, however large it is
    title, _, caption = text.strip().partition("\n")
    return _described(team, title, caption, source)


def _archive(folder: Path, team: str) -> Entry:
    manifest = folder / MANIFEST_FILE
    if not manifest.is_file() or manifest.stat().st_size > SMALL:
        raise InputError(f"expected an archive of `hdrlab submit`, it has no {MANIFEST_FILE}")
    try:
        said: Any = json.loads(manifest.read_text(encoding="utf8"))
        title, caption, artifact = (str(said[name]) for name in ("title", "caption", "artifact"))
    except (ValueError, KeyError, TypeError, RecursionError):
        raise InputError(
            f"expected an archive of `hdrlab submit`, its {MANIFEST_FILE} is damaged"
        ) from None
    inside = {
        path.relative_to(folder).as_posix(): path for path in folder.rglob("*") if path.is_file()
    }
    if artifact not in inside:
        raise InputError(
            f"expected an artifact in the archive, got the name {sanitize_line(artifact, 40)!r}"
        )
    return _described(team, title, caption, inside[artifact])


def _described(team: str, title: str, caption: str, picture: Path) -> Entry:
    return Entry(
        team, sanitize_line(title, TITLE) or "Untitled", sanitize_line(caption, CAPTION), picture
    )
