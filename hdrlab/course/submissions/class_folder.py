"""Find the submissions of a class: which file belongs to which team, and which one counts.

A file or folder belongs to a team if its name starts with the team's name or a student's id,
followed by nothing or by a character other than a letter or digit: b0123.ipynb, b0123_hw2.py,
team7-hw2.zip. A file in a folder belongs to the team that the folder's name gives, whatever the
file's own name. Names that Moodle or Canvas give to the files of a download are known too, see
`platform_names`. If a team has several files, the one that was received last counts.
"""

import hashlib
import os
import stat
import unicodedata
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from itertools import islice
from pathlib import Path
from types import MappingProxyType

from hdrlab.course.sanitize import sanitize_line
from hdrlab.course.students import csv_tables
from hdrlab.course.students.roster import Roster
from hdrlab.course.submissions.platform_names import PlatformNames
from hdrlab.errors import InputError

SUFFIXES = (".ipynb", ".py", ".zip", ".tar", ".gz", ".tgz", ".xz", ".bz2")
MAX_FILE_MEGABYTES = 256  # as much as an archive may unpack to
MAX_FILES_PER_FOLDER = 1000
MAX_NAME_LENGTH = 80
NOT_IN_TABLE = "not in the table of times, so it is not late"
FILE_TIME = "not in the table of times, so its modification time counts"


@dataclass(frozen=True)
class Submission:
    """The file of a team that counts.

    Attributes
    ----------
    team, students : whose it is
    path : the file
    received : when it was received, or last modified if that is unknown
    digest : SHA-256 of its bytes
    note : what the gradebook says about it
    can_be_late : whether late days are counted from `received`
    """

    team: str
    students: tuple[str, ...]
    path: Path
    received: datetime
    digest: str
    note: str = ""
    can_be_late: bool = True


@dataclass(frozen=True)
class SubmissionScan:
    """What was found in a folder of submissions.

    Attributes
    ----------
    submissions : the submission of each team that counts
    notes : about files that do not count, and other things to report
    refused : for each team that handed in files none of which can count, why
    """

    submissions: dict[str, Submission]
    notes: tuple[str, ...]
    refused: dict[str, str]


def find(
    folder: str | Path,
    roster: Roster,
    received: Mapping[str, datetime] | None = None,
    *,
    file_times: bool = False,
    teams_by_number: Mapping[str, str] = MappingProxyType({}),
) -> SubmissionScan:
    """Find the submissions of a class in a folder and its subfolders. Links are not followed.

    Parameters
    ----------
    folder : contains the files, or a folder for each team or student
    roster : the class
    received : when each file was received, by its path in the folder
    file_times : whether the modification time of a file without an entry tells whether it is late;
        a copy of a file is often as new as the download, so by default nobody is late by it. Which
        file of a team counts is told by it in any case
    teams_by_number : the team of each participant of a Moodle assignment, by the number in the
        names of its files

    Raises
    ------
    InputError
        If it is not a folder.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise InputError(f"{folder}: expected a folder with submissions")
    scanner = _Scanner(folder, roster, received or {}, file_times, teams_by_number)
    for path, problem in _list_files(folder):
        scanner.add(path, problem)
    return scanner.finish()


class _Scanner:
    """Collects the files of a folder, and decides which count."""

    def __init__(
        self,
        folder: Path,
        roster: Roster,
        received: Mapping[str, datetime],
        file_times: bool,
        teams_by_number: Mapping[str, str],
    ) -> None:
        self._folder = folder
        self._roster = roster
        self._teams = roster.teams()
        self._has_table = bool(received)
        self._file_times = file_times
        self._platform_names = PlatformNames(roster, teams_by_number)
        self._unused_times = dict(received)
        self._submissions: dict[str, Submission] = {}
        self._notes: list[str] = []
        self._refused: dict[str, str] = {}

    def add(self, path: Path, problem: str) -> None:
        """Take a file as the submission of its team, or note why it does not count."""
        name = path.relative_to(self._folder).as_posix()
        team, warning = self._find_team(name.partition("/")[0])
        received = self._unused_times.pop(_table_key(name), None)
        if team is None and not name.lower().endswith(SUFFIXES):
            return
        if team is None:
            self._note(name, problem or warning or "no student or team of the roster has this name")
            return
        if problem:
            self._refused[team] = self._note(name, problem)
            return
        if received is None:
            received = self._received_by_bare_name(path, team)
        note = ""
        can_be_late = received is not None or self._file_times
        if received is None:
            received = datetime.fromtimestamp(path.stat().st_mtime, UTC)
            if self._has_table:
                note = FILE_TIME if self._file_times else NOT_IN_TABLE
                self._note(name, note)
        students = tuple(student.id for student in self._teams[team])
        submission = Submission(
            team, students, path, received, digest="", note=note, can_be_late=can_be_late
        )
        self._keep_later(submission)

    def _find_team(self, name: str) -> tuple[str | None, str]:
        """Return the team of a file or folder, or None and why it is not clear, or None and ""."""
        teams = self._platform_names.find_teams(name)
        owner = self._roster.owner(name)
        if owner is not None:
            teams.add(owner)
        if len(teams) > 1:
            choices = " or ".join(sorted(teams))
            return None, f"could be of {choices}; begin its name with the student's id"
        return (teams.pop() if teams else None), ""

    def finish(self) -> SubmissionScan:
        """Return what was found."""
        for name in self._unused_times:
            self._note(name, "listed in the table of times, but there is no such file")
        submissions = {
            team: replace(submission, digest=_digest(submission.path))
            for team, submission in self._submissions.items()
        }
        refused = {
            team: reason for team, reason in self._refused.items() if team not in submissions
        }
        return SubmissionScan(submissions, tuple(self._notes), refused)

    def _received_by_bare_name(self, path: Path, team: str) -> datetime | None:
        """Return the time that the table gives for a file in a subfolder by its name alone."""
        is_clear = self._roster.owner(path.name) == team
        if not is_clear or (self._folder / path.name).exists():
            return None
        return self._unused_times.pop(_table_key(path.name), None)

    def _keep_later(self, submission: Submission) -> None:
        team = submission.team
        if team in self._submissions:
            earlier, submission = sorted(
                (self._submissions[team], submission),
                key=lambda either: (either.received, either.path.name),
            )
            self._note(earlier.path.name, f"{team} has handed in another file later")
        self._submissions[team] = submission

    def _note(self, name: str, text: str) -> str:
        note = f"{sanitize_line(name, MAX_NAME_LENGTH)}: {text}"
        self._notes.append(note)
        return note


def _list_files(folder: Path) -> Iterator[tuple[Path, str]]:
    """Yield the files of a folder and its subfolders, each with why it cannot count, or ""."""
    for entry in sorted(folder.iterdir()):
        if not entry.is_dir() or entry.is_symlink():
            paths = [entry]
        else:
            try:
                paths = sorted(islice(entry.iterdir(), MAX_FILES_PER_FOLDER + 1))
            except OSError:
                yield entry, "a folder that cannot be read"
                continue
        if len(paths) > MAX_FILES_PER_FOLDER:
            yield entry, f"expected at most {MAX_FILES_PER_FOLDER} files in a folder"
            continue
        for path in paths:
            if not path.name.startswith("."):
                yield path, find_problem(path)


def find_problem(path: Path) -> str:
    """Return why a file cannot count, or ""."""
    status = path.lstat()
    if stat.S_ISDIR(status.st_mode):
        return "a folder in a folder, which is not opened"
    if not stat.S_ISREG(status.st_mode):
        return "expected an ordinary file, got a link, a pipe or a device"
    if not os.access(path, os.R_OK):
        return "a file that cannot be read"
    if not path.name.lower().endswith(SUFFIXES):
        return "expected a notebook, a Python file or an archive"
    if status.st_size > MAX_FILE_MEGABYTES * 2**20:
        return f"expected at most {MAX_FILE_MEGABYTES} MB, got {status.st_size >> 20}"
    try:
        datetime.fromtimestamp(status.st_mtime, UTC)
    except (ValueError, OverflowError, OSError):
        return "expected a modification time before the year 10000"
    return ""


def _digest(path: Path) -> str:
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _table_key(name: str) -> str:
    """Return a path in the form in which the table of received times is searched for it."""
    return unicodedata.normalize("NFC", name.replace("\\", "/").removeprefix("./"))


def read_times(path: Path) -> dict[str, datetime]:
    """Read when files were received, from a table with the columns file and received.

    Raises
    ------
    InputError
        For another table, a time without a time zone, or a file with two rows.
    """
    times: dict[str, datetime] = {}
    for row in csv_tables.read_csv(path):
        try:
            name = _table_key(row["file"])
            received = datetime.fromisoformat(row["received"])
        except (KeyError, ValueError):
            raise InputError(
                f"{path}: expected the columns file and received, "
                f"with times such as 2026-03-01T12:00+01:00"
            ) from None
        if received.tzinfo is None:
            raise InputError(f"{path}: expected times with a time zone, got {row['received']}")
        if name in times:
            shown_name = sanitize_line(name, MAX_NAME_LENGTH)
            raise InputError(f"{path}: expected each file once, got {shown_name} twice")
        times[name] = received
    return times
