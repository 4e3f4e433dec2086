"""Read the roster: the students of a class and their teams. Students work alone or in teams.

The roster is a CSV file with the column `student` (the number or name at the university) and
optionally `name`, `email` and `team`. A student without a team works alone.
"""

import unicodedata
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from hdrlab.course.plan import TEAM_SIZE
from hdrlab.course.sanitize import sanitize_line
from hdrlab.course.students import csv_tables
from hdrlab.errors import InputError

MAX_NAME_LENGTH = 80
MAX_EMAIL_LENGTH = 200
# an id or a team names files, so these must not occur in it
FORBIDDEN_CHARACTERS = set('/\\:*?"<>|') | {chr(code) for code in range(32)}


def fold(name: str) -> str:
    """Return a name for comparison: without case, and with one way of writing each letter.

    Examples
    --------
    >>> fold("B03") == fold("b03") == fold("\uff22\uff10\uff13"), fold("e\u0301") == fold("\u00c9")
    (True, True)
    """
    return unicodedata.normalize("NFKC", unicodedata.normalize("NFKC", name).casefold())


def _prefixes(key: str) -> Iterator[str]:
    """Yield a folded name, and its parts before a character that is no letter or digit, longest first."""
    for end in range(len(key), 0, -1):
        if end == len(key) or not (key[end].isalnum() or unicodedata.combining(key[end])):
            yield key[:end]


class Student(NamedTuple):
    """A student of the class; without a partner, `team` is the student's own id."""

    id: str
    name: str
    team: str
    email: str = ""


class Name(NamedTuple):
    """An id or a team in a line of the roster, and the owner of the files that begin with it."""

    text: str
    kind: str
    line: int
    owner: str


class Roster(NamedTuple):
    """The class, in the order of its file."""

    students: tuple[Student, ...]

    def find(self, id: str) -> Student:
        """Return the student with an id, in upper or lower case; raise an InputError if there is none."""
        shown_id = sanitize_line(id, MAX_NAME_LENGTH)
        for student in self.students:
            if fold(student.id) == fold(shown_id):
                return student
        raise InputError(f"expected a student of the roster, got {shown_id!r}")

    def teams(self) -> dict[str, tuple[Student, ...]]:
        """Return the members of each team, in the order of the roster."""
        teams: dict[str, list[Student]] = {}
        for student in self.students:
            teams.setdefault(student.team, []).append(student)
        return {team: tuple(members) for team, members in teams.items()}

    def owner(self, file: str) -> str | None:
        """Return the team that a file belongs to: its name begins with the team's name or a student's id.

        Examples
        --------
        >>> roster = Roster((Student("b1", "Ada", "t"), Student("b12", "Bo", "b12")))
        >>> [roster.owner(name) for name in ("B1_hw2.ipynb", "b12.py", "t-hw2.zip", "b123.py", "xb1.py")]
        ['t', 'b12', 't', None, None]
        """
        teams: dict[str, str] = {}
        for student in self.students:
            teams[fold(student.team)] = student.team
            teams[fold(student.id)] = student.team
        for prefix in _prefixes(fold(file)):
            if prefix in teams:
                return teams[prefix]
        return None

    def find_team(self, name: str) -> str:
        """Return the team with this name, or of the student with this id, in upper or lower case.

        Examples
        --------
        >>> roster = Roster((Student("b1", "Ada", "t1"), Student("b2", "Bo", "t1")))
        >>> roster.find_team("T1"), roster.find_team("B2")
        ('t1', 't1')

        Raises
        ------
        InputError
            For a name that the roster does not have, and for one that could mean two teams.
        """
        shown_name = sanitize_line(name, MAX_NAME_LENGTH)
        wanted = fold(shown_name)
        teams = {
            student.team
            for student in self.students
            if wanted in (fold(student.id), fold(student.team))
        }
        if not teams:
            raise InputError(f"the roster has no student or team {shown_name!r}")
        if len(teams) > 1:
            choices = ", ".join(sorted(teams))
            raise InputError(f"{shown_name!r} could mean any of {choices}; use the student's id")
        (team,) = teams
        return team


def read(path: str | Path, *, team_size: int = TEAM_SIZE) -> Roster:
    """Read a roster, in which a team has at most `team_size` students.

    Raises
    ------
    InputError
        If an id or a team cannot name a file, a team has too many members, or two names could be
        confused; the message has both lines.
    """
    rows = csv_tables.read_csv(path)
    if not rows or "student" not in rows[0]:
        raise InputError(
            f"{path}: expected the column student, and optionally name, email and team"
        )
    students = []
    names: list[Name] = []
    for line, row in enumerate(rows, 2):
        id = sanitize_line(row.get("student", ""), MAX_NAME_LENGTH)
        team = sanitize_line(row.get("team", ""), MAX_NAME_LENGTH)
        name = sanitize_line(row.get("name", ""), MAX_NAME_LENGTH)
        email = sanitize_line(row.get("email", ""), MAX_EMAIL_LENGTH)
        owner = f"team {team}" if team else f"line {line}"
        names.append(Name(id, "student's id", line, owner))
        if team:
            names.append(Name(team, "team's name", line, owner))
        students.append(Student(id=id, name=name or id, team=team or id, email=email))
    _check_names(path, names)
    sizes = Counter(student.team for student in students)
    large = [team for team, size in sizes.items() if size > team_size]
    if large:
        raise InputError(
            f"{path}: expected teams of at most {team_size} students, got more in "
            f"{', '.join(large)}; team_size in the course plan allows larger teams"
        )
    return Roster(tuple(students))


def _check_names(path: str | Path, names: list[Name]) -> None:
    """Raise an InputError for a name that cannot name a file, and for two names that could be confused.

    Two names can be confused if they are equal, or if one begins with the other and continues with
    a character that is no letter or digit: the files of one could be taken for those of the other.
    """
    for text, kind, line, _ in names:
        if not text or text[0] in ".-" or FORBIDDEN_CHARACTERS & set(text):
            raise InputError(
                f"{path}, line {line}: expected a {kind} that can be a file name, got {text!r}"
            )
    known: dict[str, Name] = {}
    for name in sorted(names, key=lambda name: len(fold(name.text))):
        key = fold(name.text)
        for prefix in _prefixes(key):
            if prefix not in known:
                continue
            other = known[prefix]
            is_repeated = name.kind == other.kind == "student's id" and key == fold(other.text)
            if is_repeated or name.owner != other.owner:
                first, second = sorted((name, other), key=lambda name: name.line)
                raise InputError(
                    f"{path}, lines {first.line} and {second.line}: the {first.kind} "
                    f"{first.text!r} and the {second.kind} {second.text!r} could be confused in "
                    "file names; use names of which none begins another"
                )
        known.setdefault(key, name)
