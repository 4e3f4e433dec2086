"""Find whose file it is by the name that a learning platform gives it in a download of a class.

Moodle  Ada Lovelace_4711_assignsubmission_file_hw2.ipynb, or hw2.ipynb in a folder
        Ada Lovelace_4711_assignsubmission_file. The number is the participant's, which the grading
        worksheet of the assignment lists. The name is "Participant" in anonymous assignments.
Canvas  lovelaceada_815_4711_hw2.ipynb, or lovelaceada_LATE_815_4711_hw2.ipynb: the letters of the
        last and the first name, the numbers of the student and of the file, and the file's name.
"""

import re
from collections.abc import Iterator, Mapping

from hdrlab.course.students.roster import Roster, fold

# The student's own file name follows, so the first match from the left is the platform's.
MOODLE_NAME = re.compile(r"(?P<name>.+?)_(?P<number>\d+)_assignsubmission_file(_|$)", re.IGNORECASE)
CANVAS_NAME = re.compile(r"(?P<name>[^_]+)(_late)?_\d+_\d+_.", re.IGNORECASE)
WORD = re.compile(r"[^\W_]+")


class PlatformNames:
    """The names that the files of a class have in a platform's download.

    Parameters
    ----------
    roster : the class, with the students' names
    teams_by_number : the team of each participant of a Moodle assignment, by the number

    Examples
    --------
    >>> from hdrlab.course.students.roster import Student
    >>> roster = Roster((Student("b1", "Ada Lovelace", "b1"), Student("b2", "Bo Li", "t2")))
    >>> names = PlatformNames(roster, {"12": "b1"})
    >>> names.find_teams("Bo Li_13_assignsubmission_file_hw2.ipynb")
    {'t2'}
    >>> names.find_teams("lovelaceada_LATE_815_4711_hw2.ipynb")
    {'b1'}
    >>> names.find_teams("Participant_12_assignsubmission_file")
    {'b1'}
    """

    def __init__(self, roster: Roster, teams_by_number: Mapping[str, str]) -> None:
        self._teams_by_number = teams_by_number
        self._teams_by_letters: dict[str, set[str]] = {}
        for student in roster.students:
            for letters in _spellings(student.name):
                self._teams_by_letters.setdefault(letters, set()).add(student.team)

    def find_teams(self, file: str) -> set[str]:
        """Return the teams that a file may belong to, by its name or that of its folder.

        This is empty for a name of another form or an unknown student, and has several teams for
        students of the same name.
        """
        moodle = MOODLE_NAME.match(file)
        if moodle and moodle["number"] in self._teams_by_number:
            return {self._teams_by_number[moodle["number"]]}
        form = moodle or CANVAS_NAME.match(file)
        if form is None:
            return set()
        letters = "".join(WORD.findall(fold(form["name"])))
        return set(self._teams_by_letters.get(letters, ()))


def _spellings(name: str) -> Iterator[str]:
    """Yield the letters of a name, beginning with each of its words in turn."""
    words = WORD.findall(fold(name))
    for first in range(len(words)):
        yield "".join([*words[first:], *words[:first]])
