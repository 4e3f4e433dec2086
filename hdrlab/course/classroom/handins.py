"""What a class has handed in: which files are whose, and which of a team's counts.

A file or folder is a team's where its name begins with the team or one of its students, and then
ends or goes on with a sign: b0123.ipynb, b0123_hw2.py, team7-hw2.zip. In a folder, the folder's
name says whose a file is, and the file's own name says nothing. Of several the last that came
counts.
"""

import hashlib
import os
import stat
import unicodedata
from collections.abc import Iterator, Mapping
from datetime import UTC, datetime
from itertools import islice
from pathlib import Path
from typing import NamedTuple

from hdrlab.course.classroom.roster import Roster
from hdrlab.course.reports import sheets
from hdrlab.course.wording import plain
from hdrlab.errors import InputError

KINDS = (".ipynb", ".py", ".zip", ".tar", ".gz", ".tgz", ".xz", ".bz2")
# bytes of a file: what an archive of one may hold
LARGEST = 1 << 28
MOST = 1000  # files in a folder
NO_ROW = "the table of times has no row for it, so the file's own time counts"


class Handin(NamedTuple):
    """What counts of a team: the file, when it came, a digest of its bytes, and what is to be said of it."""

    team: str
    students: tuple[str, ...]
    path: Path
    received: datetime
    digest: str
    note: str = ""


class Found(NamedTuple):
    """What counts, by team; what is to be said of the rest; why nothing counts of teams that handed in."""

    handins: dict[str, Handin]
    notes: tuple[str, ...]
    refused: dict[str, str]


def find(
    folder: str | Path, roster: Roster, received: Mapping[str, datetime] | None = None
) -> Found:
    """Return what a class has handed in.

    Parameters
    ----------
    folder : where the files lie, or folders of them; links in it are not followed
    roster : the class
    received : when a file came, by its path in the folder; else the time of the file itself

    Raises
    ------
    ValueError
        For what is no folder.
    """
    folder, teams = Path(folder), roster.teams()
    if not folder.is_dir():
        raise InputError(f"{folder}: expected the folder of what was handed in")
    rows, notes = dict(received or {}), []
    handins: dict[str, Handin] = {}
    refused: dict[str, str] = {}
    for path, why in _files(folder):
        name = path.relative_to(folder).as_posix()
        team, when = roster.owner(name.partition("/")[0]), rows.pop(_key(name), None)
        if team is None and not name.lower().endswith(KINDS):
            continue
        if why or team is None:
            notes.append(f"{plain(name, 80)}: {why or 'the roster knows nobody of that name'}")
            refused |= {team: notes[-1]} if team else {}
            continue
        if when is None and roster.owner(path.name) == team:  # a row with the file's bare name
            when = rows.pop(_key(path.name), None) if not (folder / path.name).exists() else None
        unknown = NO_ROW if received and when is None else ""
        notes += [f"{plain(name, 80)}: {unknown}"] if unknown else []
        when = when or datetime.fromtimestamp(path.stat().st_mtime, UTC)
        students = tuple(one.id for one in teams[team])
        fresh = Handin(team, students, path, when, "", unknown)
        if team in handins:
            older, fresh = sorted(
                (handins[team], fresh), key=lambda one: (one.received, one.path.name)
            )
            notes.append(f"{plain(older.path.name, 80)}: {team} has handed in another, later")
        handins[team] = fresh
    notes += [
        f"{plain(name, 80)}: the table of times names it, there is no such file" for name in rows
    ]
    handins = {team: one._replace(digest=_digest(one.path)) for team, one in handins.items()}
    return Found(
        handins, tuple(notes), {team: why for team, why in refused.items() if team not in handins}
    )


def _files(folder: Path) -> Iterator[tuple[Path, str]]:
    """Yield what lies in a folder and one below it, by name, and why it cannot count, or ""."""
    for path in sorted(folder.iterdir()):
        inside = [path]
        if path.is_dir() and not path.is_symlink():
            try:
                inside = sorted(islice(path.iterdir(), MOST + 1))
            except OSError:
                yield path, "a folder that cannot be read"
        if len(inside) > MOST:
            yield path, f"expected at most {MOST} files in a folder"
            continue
        yield from ((one, _why_not(one)) for one in inside if not one.name.startswith("."))


def _why_not(path: Path) -> str:
    """Return why a file cannot count, or ""."""
    found = path.lstat()
    if stat.S_ISDIR(found.st_mode):
        return "a folder in a folder, which is not opened"
    if not stat.S_ISREG(found.st_mode):
        return "expected a plain file, got a link, a pipe or a device"
    if not os.access(path, os.R_OK):
        return "a file that cannot be read"
    if not path.name.lower().endswith(KINDS):
        return "expected a notebook, a Python file or an archive"
    if found.st_size > LARGEST:
        return f"expected at most {LARGEST >> 20} MB, got {found.st_size >> 20}"
    try:
        datetime.fromtimestamp(found.st_mtime, UTC)
    except (ValueError, OverflowError, OSError):
        return "expected a time before the year 10000"
    return ""


def _digest(path: Path) -> str:
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _key(name: str) -> str:
    """Return the path of a file as a table of times is searched for it."""
    return unicodedata.normalize("NFC", name.replace("\\", "/").removeprefix("./"))


def read_times(path: Path) -> dict[str, datetime]:
    """Return when files came, from a table with the columns file and received.

    Raises
    ------
    ValueError
        For another table, a time without a zone, and a file with two rows.
    """
    came: dict[str, datetime] = {}
    for row in sheets.read_csv(path):
        try:
            name, when = _key(row["file"]), datetime.fromisoformat(row["received"])
        except (KeyError, ValueError):
            says = f"{path}: expected the columns file and received, 2026-03-01T12:00+01:00"
            raise InputError(says) from None
        if when.tzinfo is None:
            raise InputError(f"{path}: expected times with a zone, got {row['received']}")
        if name in came:
            raise InputError(f"{path}: expected each file once, got {plain(name, 80)} twice")
        came[name] = when
    return came
