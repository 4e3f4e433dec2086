"""What is to hang: pictures named after a team or a student, and archives that `hdrlab submit` has made.

A picture `team7.jpg` may have a file `team7.txt` beside it: the title in its first line, then a caption.
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

from hdrlab.course.archives import unpack
from hdrlab.course.classroom.roster import Roster
from hdrlab.course.gallery import pictures, store
from hdrlab.course.projects.project import MANIFEST
from hdrlab.course.wording import plain

TITLE, CAPTION = 60, 280  # characters
SMALL = 1_000_000  # bytes of a text
ARCHIVES = (".zip", ".tar", ".tar.gz", ".tgz", ".tar.bz2", ".tar.xz")
NOT_THESE = (".txt", ".csv")


class Entry(NamedTuple):
    """An artifact that a team hands in."""

    team: str
    title: str
    caption: str
    picture: Path


def sources(paths: Sequence[Path]) -> list[Path]:
    """Return the pictures and archives that are meant: files as they are, and those in folders."""
    found = []
    for path in paths:
        inside = sorted(path.iterdir()) if path.is_dir() else [path]
        found += [one for one in inside if one.suffix.lower() not in NOT_THESE and one.name[0] != "."]
    return found


@contextmanager
def entry(source: Path, roster: Roster) -> Iterator[Entry]:
    """Yield the Entry of a picture or an archive, which is unpacked meanwhile.

    Raises
    ------
    ValueError
        For an archive with a trap, without a description or an artifact, and for students of no team.
    """
    if not source.name.lower().endswith(ARCHIVES):
        yield _picture(source, roster)
        return
    with tempfile.TemporaryDirectory(prefix="hdrlab-") as scratch:
        folder = Path(scratch) / "submission"
        unpack.unpack(source, folder)
        yield _archive(folder, roster)


def hang(db: sqlite3.Connection, folder: Path, one: Entry) -> None:
    """Make an artifact's pictures, and put it on the wall."""
    prepared = pictures.prepare(one.picture)
    seal = hmac.new(store.settings(db).secret, one.team.encode() + b"\0", hashlib.sha256)
    seal.update(prepared.files["large"])
    id = seal.hexdigest()[:24]  # nobody can tell the address of another picture
    pictures.keep(folder / store.PICTURES, id, prepared)
    with store.transaction(db):
        store.hang(db, store.Artifact(id, one.team, one.title, one.caption, prepared.width, prepared.height))


def _picture(source: Path, roster: Roster) -> Entry:
    stem, words = source.stem, source.with_suffix(".txt")
    teams = {team.casefold(): team for team in roster.teams()}
    team = teams.get(stem.casefold()) or roster.team_of([stem])
    text = words.read_text(encoding="utf8", errors="replace")[:SMALL] if words.is_file() else ""
    title, _, caption = text.strip().partition("\n")
    return _described(team, title, caption, source)


def _archive(folder: Path, roster: Roster) -> Entry:
    manifest = folder / MANIFEST
    if not manifest.is_file() or manifest.stat().st_size > SMALL:
        raise ValueError(f"expected an archive of `hdrlab submit`, it has no {MANIFEST}")
    try:
        said: Any = json.loads(manifest.read_text(encoding="utf8"))
        students = [str(one) for one in said["students"]]
        title, caption, artifact = (str(said[name]) for name in ("title", "caption", "artifact"))
    except (ValueError, KeyError, TypeError, RecursionError):
        raise ValueError(f"expected an archive of `hdrlab submit`, its {MANIFEST} is damaged") from None
    inside = {path.relative_to(folder).as_posix(): path for path in folder.rglob("*") if path.is_file()}
    if artifact not in inside:
        raise ValueError(f"expected an artifact in the archive, got the name {plain(artifact, 40)!r}")
    return _described(roster.team_of(students), title, caption, inside[artifact])


def _described(team: str, title: str, caption: str, picture: Path) -> Entry:
    return Entry(team, plain(title, TITLE) or "Untitled", plain(caption, CAPTION), picture)
