"""A class's submissions are graded, one by one: what there is to do, and how one of them is done.

RESULTS/
  results/      a file for each submission, of which everything else is made
  feedback/     for each team, a page, and what other systems read
  and what is written about the whole class: see `overview`
"""

import tempfile
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from datetime import datetime
from functools import cache
from pathlib import Path
from typing import NamedTuple

from hdrlab.course import grading
from hdrlab.course.checks import rewording
from hdrlab.course.classroom import journal
from hdrlab.course.classroom.handins import Handin
from hdrlab.course.classroom.journal import Done, Piece
from hdrlab.course.classroom.late import Handed
from hdrlab.course.classroom.roster import Roster
from hdrlab.course.plan import Conditions, Homework, Late
from hdrlab.course.reports import gradebook, results
from hdrlab.course.sandbox import doctor, running
from hdrlab.course.wording import plain
from hdrlab.errors import InputError

MOST = 1 << 26  # bytes of hidden checks, which travel with each submission


class Course(NamedTuple):
    """What a class is graded by.

    Attributes
    ----------
    roster : who is in it
    homework, conditions : what is checked, and under which conditions
    late : the rule for what comes late
    before : what was handed in for earlier homeworks, in the order they were due
    """

    roster: Roster
    homework: Homework
    conditions: Conditions
    late: Late = Late()
    before: Sequence[Handed] = ()


class Grader(NamedTuple):
    """Grades one submission; it can be sent to another process, and to a machine without this one's files.

    Attributes
    ----------
    homework, conditions : what is checked, and how
    hidden : the instructor's own checks and what stands beside them, by name; see `hidden`
    """

    homework: Homework
    conditions: Conditions
    hidden: Sequence[tuple[str, bytes]] = ()

    def ready(self) -> None:
        """Raise Unavailable on a machine that cannot give the tier: said once, and not by each submission."""
        _ready(self.conditions.tier)

    def result(self, piece: Piece) -> bytes:
        """Return the result of a submission as JSON.

        A function whose process was killed is asked again: a tier for credit lets none kill itself,
        so it was somebody else, or a system out of memory. Such a result is believed when it comes
        each time.

        Raises
        ------
        ValueError
            Where it never does.
        """
        each: list[results.Result] = []
        while len(each) < journal.TRIES:
            each.append(self._result(piece))
            if all(one.kind != "killed" for one in each[-1].checks):
                return results.to_json(each[-1])
        if each.count(each[0]) == len(each):
            return results.to_json(each[0])
        raise InputError(
            "its functions' process ended without an answer, each time at another check"
        )

    def _result(self, piece: Piece) -> results.Result:
        """Grade a submission."""
        student = piece.owner if self.conditions.secret else ""
        with tempfile.TemporaryDirectory(prefix="hdrlab-class-") as scratch:
            hidden = _laid(self.hidden, Path(scratch) / "hidden") if self.hidden else None
            conditions = self.conditions._replace(student=student, hidden=hidden)
            result = grading.grade(piece.path, self.homework, conditions)
        return result._replace(student=piece.owner)


@cache
def _ready(tier: str) -> None:
    """Raise Unavailable where a tier cannot be had; a process asks once."""
    found = doctor.examine(tier)
    if not found.works:
        raise running.Unavailable(found.says)


def hidden(folder: Path | None) -> list[tuple[str, bytes]]:
    """Return the instructor's own checks, which travel with the work.

    Raises
    ------
    ValueError
        For what is no folder, or holds more than a submission can carry along.
    """
    if folder is None:
        return []
    if not folder.is_dir():
        raise InputError(f"expected a folder with hidden checks, got {folder}")
    files = [
        path
        for path in sorted(folder.rglob("*"))
        if path.is_file() and "__pycache__" not in path.parts
    ]
    if (size := sum(path.stat().st_size for path in files)) > MOST:
        raise InputError(f"{folder}: expected hidden checks of at most {MOST} bytes, got {size}")
    return [(path.relative_to(folder).as_posix(), path.read_bytes()) for path in files]


def _laid(files: Iterable[tuple[str, bytes]], folder: Path) -> Path:
    """Write files into a new folder, and return it."""
    for name, data in files:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)
    return folder


def pieces(
    handins: Mapping[str, Handin], homework: Homework, conditions: Conditions
) -> list[Piece]:
    """Return what there is to do: a key holds the submission, the specification and the conditions."""
    words = [rewording.FOLDER / f"{task.id}.toml" for task in homework.tasks if task.parameters]
    files = grading.specification([*grading.files_of(homework, conditions.hidden), *words])
    asked = repr(
        [homework.name, homework.tasks, conditions.tier, conditions.secret, conditions.timeout]
    )
    return [
        Piece(team, one.path, journal.key(one.digest, files, asked))
        for team, one in handins.items()
    ]


def select_handins(
    handins: Mapping[str, Handin],
    roster: Roster,
    only: Collection[str] = (),
    since: datetime | None = None,
) -> dict[str, Handin]:
    """Return the submissions of some students or teams, received at or after a time.

    Names match in any case, as everywhere in a class: "T1" is the team t1. Without `only`, all
    students count.

    Raises
    ------
    InputError
        For a name that the roster does not know, or from whom there is no submission.
    """
    teams = {roster.find_team(name) for name in only}
    missing = sorted(teams - set(handins))
    if missing:
        raise InputError(f"expected names that have handed in, got {', '.join(missing)}")
    return {
        team: handin
        for team, handin in handins.items()
        if (not only or team in teams) and (since is None or handin.received >= since)
    }


def write_feedback(out: Path, done: Done) -> Done:
    """Write a team's feedback, unless all of it is there and of this result; return what was `done`.

    It is of this result where its JSON is, which is removed first and written last. What fails is
    `why`.
    """
    if done.result is None:
        return done
    try:
        folder, data = out / "feedback" / done.piece.owner, done.result.read_bytes()
        whole, shown = folder / "result.json", results.for_team(data)
        missing = [name for name in gradebook.FILES if not (folder / name).is_file()]
        if missing or whole.read_bytes() != shown:
            for one in (folder.parent, folder):
                journal.make_private(one)
            whole.unlink(missing_ok=True)
            gradebook.write_results(folder, results.from_json(data), shown)
    except Exception as error:  # whatever it is: the others are to be told theirs
        why = plain(f"{type(error).__name__}: {error}", 200)
        return done._replace(why=f"its feedback could not be written: {why}")
    return done


def read(out: Path, everything: Sequence[Piece]) -> Iterator[results.Result]:
    """Yield the results that are there, one at a time: a large class has more pictures than memory."""
    for piece in everything:
        path = journal.place(out / "results", piece)
        if path.is_file():
            with suppress(ValueError):  # a damaged one is not graded, of which write_feedback tells
                yield results.from_json(path.read_bytes())
