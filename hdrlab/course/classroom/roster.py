"""The class: who is in it, and who works with whom. Students work alone or in teams of two.

The roster is a CSV file with the columns `student` (the number or name at the university) and, where wanted,
`name`, `email` and `team`. Who has no team works alone.
"""

from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from hdrlab.course.reports import sheets
from hdrlab.course.wording import plain

TEAM = 2  # students at most
NAME = 80  # characters
FORBIDDEN = set('/\\:*?"<>|') | {chr(code) for code in range(32)}  # an id or a team names files


class Student(NamedTuple):
    """One of the class; `team` is the student's own id where there is no partner."""

    id: str
    name: str
    team: str
    email: str = ""


class Roster(NamedTuple):
    """The class, in the order of its file."""

    students: tuple[Student, ...]

    def find(self, id: str) -> Student:
        """Return a student by id, whatever its case, or raise a ValueError."""
        wanted = plain(id, NAME).casefold()
        for one in self.students:
            if one.id.casefold() == wanted:
                return one
        raise ValueError(f"expected a student of the roster, got {plain(id, NAME)!r}")

    def teams(self) -> dict[str, tuple[Student, ...]]:
        """Return who is in each team, in the order of the roster."""
        found: dict[str, list[Student]] = {}
        for one in self.students:
            found.setdefault(one.team, []).append(one)
        return {team: tuple(members) for team, members in found.items()}

    def team_of(self, ids: Iterable[str]) -> str:
        """Return the team that a submission's students are; all of them must be of one.

        Examples
        --------
        >>> roster = Roster((Student("b1", "Ada", "t"), Student("b2", "Bo", "t"), Student("b3", "Cy", "b3")))
        >>> roster.team_of(["b2"]), roster.team_of(["b1", "B2"])
        ('t', 't')
        >>> roster.team_of(["b1", "b3"])
        Traceback (most recent call last):
        ValueError: expected students of one team, got b1 of t, b3 of b3
        """
        students = [self.find(id) for id in ids]
        if len({one.team for one in students}) != 1:
            said = ", ".join(f"{one.id} of {one.team}" for one in students)
            raise ValueError(f"expected students of one team, got {said or 'none'}")
        return students[0].team


def read(path: str | Path) -> Roster:
    """Read a roster.

    Raises
    ------
    ValueError
        Where a student is missing or there twice, an id or a team cannot name a file, or a team is of three.
    """
    rows = sheets.read_csv(path)
    if not rows or "student" not in rows[0]:
        raise ValueError(f"{path}: expected the column student, and name, email, team where wanted")
    students = tuple(_students(path, rows))
    _check(path, students)
    return Roster(students)


def _students(path: str | Path, rows: list[dict[str, str]]) -> Iterator[Student]:
    for line, row in enumerate(rows, 2):
        id = plain(row["student"], NAME)
        team = plain(row.get("team", ""), NAME) or id
        for what, name in (("student's id", id), ("team's name", team)):
            if not name or name[0] in ".-" or FORBIDDEN & set(name):
                raise ValueError(f"{path}, line {line}: expected a {what} that can name a file, got {name!r}")
        yield Student(id, plain(row.get("name", ""), NAME) or id, team, plain(row.get("email", ""), 200))


def _check(path: str | Path, students: tuple[Student, ...]) -> None:
    twice = [id for id, count in Counter(one.id.casefold() for one in students).items() if count > 1]
    if twice:
        raise ValueError(f"{path}: expected each student once, got {', '.join(twice)} more often")
    large = [team for team, count in Counter(one.team for one in students).items() if count > TEAM]
    if large:
        raise ValueError(f"{path}: expected teams of {TEAM} at most, got more in {', '.join(large)}")
