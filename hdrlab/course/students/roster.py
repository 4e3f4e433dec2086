"""The class: who is in it, and who works with whom. Students work alone or in teams of two.

The roster is a CSV file with the columns `student` (the number or name at the university) and,
where wanted, `name`, `email` and `team`. Who has no team works alone.
"""

import unicodedata
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from hdrlab.course.sanitize import sanitize_line
from hdrlab.course.students import csv_tables
from hdrlab.errors import InputError

TEAM = 2  # students at most
NAME = 80  # characters
FORBIDDEN = set('/\\:*?"<>|') | {chr(code) for code in range(32)}  # an id or a team names files


def fold(name: str) -> str:
    """Return a name as names are compared: case and Unicode's other ways of writing a letter do not count.

    Examples
    --------
    >>> fold("B03") == fold("b03") == fold("\uff22\uff10\uff13"), fold("e\u0301") == fold("\u00c9")
    (True, True)
    """
    return unicodedata.normalize("NFKC", unicodedata.normalize("NFKC", name).casefold())


def _beginnings(key: str) -> Iterator[str]:
    """Yield a folded name, and what stands in it before a sign, from the longest on."""
    for end in range(len(key), 0, -1):
        if end == len(key) or not (key[end].isalnum() or unicodedata.combining(key[end])):
            yield key[:end]


class Student(NamedTuple):
    """One of the class; `team` is the student's own id where there is no partner."""

    id: str
    name: str
    team: str
    email: str = ""


class Name(NamedTuple):
    """An id or a team as a line of the roster has it, and whose files begin with it."""

    text: str
    kind: str
    line: int
    owner: str


class Roster(NamedTuple):
    """The class, in the order of its file."""

    students: tuple[Student, ...]

    def find(self, id: str) -> Student:
        """Return a student by id, whatever its case, or raise a ValueError."""
        wanted = fold(sanitize_line(id, NAME))
        for one in self.students:
            if fold(one.id) == wanted:
                return one
        raise InputError(f"expected a student of the roster, got {sanitize_line(id, NAME)!r}")

    def teams(self) -> dict[str, tuple[Student, ...]]:
        """Return who is in each team, in the order of the roster."""
        found: dict[str, list[Student]] = {}
        for one in self.students:
            found.setdefault(one.team, []).append(one)
        return {team: tuple(members) for team, members in found.items()}

    def owner(self, file: str) -> str | None:
        """Return the team whose file it is: its name begins with the team's or a student's.

        Examples
        --------
        >>> roster = Roster((Student("b1", "Ada", "t"), Student("b12", "Bo", "b12")))
        >>> [roster.owner(name) for name in ("B1_hw2.ipynb", "b12.py", "t-hw2.zip", "b123.py", "xb1.py")]
        ['t', 'b12', 't', None, None]
        """
        teams = {fold(name): one.team for one in self.students for name in (one.team, one.id)}
        return next((teams[one] for one in _beginnings(fold(file)) if one in teams), None)

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
        shown_name = sanitize_line(name, NAME)
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


def read(path: str | Path) -> Roster:
    """Read a roster.

    Raises
    ------
    ValueError
        Where an id or a team cannot name a file, a team is of three, or a name could be taken for another's:
        both lines are named.
    """
    rows = csv_tables.read_csv(path)
    if not rows or "student" not in rows[0]:
        raise InputError(
            f"{path}: expected the column student, and optionally name, email and team"
        )
    students = []
    names: list[Name] = []
    for line, row in enumerate(rows, 2):
        id, team, name = (
            sanitize_line(row.get(column, ""), NAME) for column in ("student", "team", "name")
        )
        owner = f"team {team}" if team else f"line {line}"
        names.append(Name(id, "student's id", line, owner))
        names += [Name(team, "team's name", line, owner)] if team else []
        students.append(
            Student(id, name or id, team or id, sanitize_line(row.get("email", ""), 200))
        )
    _check_names(path, names)
    large = [team for team, count in Counter(one.team for one in students).items() if count > TEAM]
    if large:
        raise InputError(
            f"{path}: expected teams of at most {TEAM} students, got more in {', '.join(large)}"
        )
    return Roster(tuple(students))


def _check_names(path: str | Path, names: list[Name]) -> None:
    """Raise a ValueError for a name that no file can have, and for two of which one could begin the other's.

    That is so where one is the other, or begins with it and goes on by a sign.
    """
    for text, kind, line, _ in names:
        if not text or text[0] in ".-" or FORBIDDEN & set(text):
            raise InputError(
                f"{path}, line {line}: expected a {kind} that can be a file name, got {text!r}"
            )
    known: dict[str, Name] = {}
    for one in sorted(names, key=lambda one: len(fold(one.text))):
        key = fold(one.text)
        for other in (known[name] for name in _beginnings(key) if name in known):
            twice = one.kind == other.kind == "student's id" and key == fold(other.text)
            if twice or one.owner != other.owner:
                first, second = sorted((one, other), key=lambda name: name.line)
                raise InputError(
                    f"{path}, lines {first.line} and {second.line}: expected each name once, and none that "
                    f"begins another; got the {first.kind} {first.text!r} and the {second.kind} "
                    f"{second.text!r}, whose files could be taken for each other's"
                )
        known.setdefault(key, one)
