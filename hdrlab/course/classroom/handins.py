"""What a class has handed in: which files are whose, and which of a team's counts.

A file or folder is a team's where its name begins with the team or one of its students, and then ends or goes
on with a sign: b0123.ipynb, b0123_hw2.py, team7-hw2.zip. Of several the last that came counts.
"""

import hashlib
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

from hdrlab.course.classroom.roster import Roster
from hdrlab.course.wording import plain

KINDS = (".ipynb", ".py", ".zip", ".tar", ".gz", ".tgz", ".xz", ".bz2")


class Handin(NamedTuple):
    """What counts of a team: the file, when it came, and a digest of its bytes."""

    team: str
    students: tuple[str, ...]
    path: Path
    received: datetime
    digest: str


class Found(NamedTuple):
    """What counts, by team, and what is to be said of the rest."""

    handins: dict[str, Handin]
    notes: tuple[str, ...]


def find(folder: str | Path, roster: Roster, received: dict[str, datetime] | None = None) -> Found:
    """Return what a class has handed in.

    Parameters
    ----------
    folder : where the files lie; links in it are not followed
    roster : the class
    received : when a file came, by its name; else the time of the file itself

    Raises
    ------
    ValueError
        For what is no folder.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise ValueError(f"{folder}: expected the folder of what was handed in")
    owners, teams, notes = _owners(roster), roster.teams(), []
    handins: dict[str, Handin] = {}
    for path in _files(folder):
        team = _team(path.relative_to(folder).parts[0], owners)
        if team is None:
            notes.append(f"{plain(path.name, 80)}: the roster knows nobody of that name")
            continue
        when = (received or {}).get(path.name) or datetime.fromtimestamp(path.stat().st_mtime, UTC)
        students = tuple(one.id for one in teams[team])
        fresh = Handin(team, students, path, when, hashlib.sha256(path.read_bytes()).hexdigest())
        before = handins.get(team)
        if before:
            older = min(before, fresh, key=lambda one: (one.received, one.path.name))
            notes.append(f"{plain(older.path.name, 80)}: {team} has handed in another, later")
        handins[team] = fresh if before is None else max(before, fresh, key=_age)
    return Found(handins, tuple(notes))


def _age(one: Handin) -> tuple[datetime, str]:
    return one.received, one.path.name


def _files(folder: Path) -> Iterator[Path]:
    """Yield the files of a folder and those one below it, by name."""
    for path in sorted(folder.iterdir()):
        inside = sorted(path.iterdir()) if path.is_dir() and not path.is_symlink() else [path]
        for one in inside:
            if one.is_file() and not one.is_symlink() and one.name.lower().endswith(KINDS):
                yield one


def _owners(roster: Roster) -> dict[str, str]:
    """Return the team behind each name that a file may begin with."""
    return {name.casefold(): one.team for one in roster.students for name in (one.team, one.id)}


def _team(name: str, owners: dict[str, str]) -> str | None:
    """Return the team of the longest name that this one begins with, before its end, or a sign."""
    folded = name.casefold()
    for end in range(len(folded), 0, -1):
        if folded[:end] in owners and not folded[end : end + 1].isalnum():
            return owners[folded[:end]]
    return None
