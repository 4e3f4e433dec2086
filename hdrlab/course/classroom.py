"""A class's submissions are graded, and what came of it is put where instructors look for it.

RESULTS/
  results/      a file for each submission, of which everything else is made
  feedback/     a page for each team, and what other systems read
  gradebook.csv, canvas.csv, class.html
"""

import tempfile
from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

from hdrlab.course import grading, journal, materials, plan, results, unpack
from hdrlab.course.grading import Conditions
from hdrlab.course.handins import Handin
from hdrlab.course.members import Refused
from hdrlab.course.plan import Homework
from hdrlab.course.results import Result
from hdrlab.show.templates import templates

READ = (".ipynb", ".py")
PAGE = "class_page.html"


class Grader(NamedTuple):
    """Grades one submission; it can be sent to another process."""

    homework: str
    plan_file: Path | None
    conditions: Conditions

    def result(self, piece: journal.Piece) -> bytes:
        """Return the result of a submission as JSON; an archive is unpacked for it, or refused in a line."""
        asked = plan.read(self.plan_file).homeworks[self.homework]
        conditions = self.conditions._replace(student=piece.owner if self.conditions.secret else "")
        with tempfile.TemporaryDirectory(prefix="hdrlab-class-") as scratch:
            path, refused = _opened(piece.path, Path(scratch), self.homework)
            result = grading.grade(path, asked, conditions)
        said = (refused, *result.problems) if refused else result.problems
        return results.to_json(result._replace(student=piece.owner, problems=said))


def _opened(path: Path, scratch: Path, homework: str) -> tuple[Path, str]:
    """Return the notebook or Python file of a submission, and why its archive was refused, or ""."""
    if path.suffix.lower() in READ:
        return path, ""
    nothing = scratch / f"{homework}.py"
    nothing.write_text("")
    try:
        members = unpack.unpack(path, scratch / "files")
    except Refused as reason:
        return nothing, f"The archive is refused: {reason}."
    fitting = [member for member, _ in members if member.suffix.lower() in READ]
    named = [member for member in fitting if homework in member.name.lower()] or fitting
    if len(named) != 1:
        names = ", ".join(member.name for member in named[:5]) or "none"
        return nothing, f"Expected one notebook or Python file in the archive, got {names}."
    return scratch / "files" / named[0], ""


def pieces(handins: Mapping[str, Handin], homework: Homework, conditions: Conditions) -> list[journal.Piece]:
    """Return what there is to do: a key holds the submission, the specification and the conditions."""
    folders = [materials.folder("tests") / "spec", *([conditions.hidden] if conditions.hidden else [])]
    checks = [folder / f"test_{task.id}.py" for folder in folders for task in homework.tasks]
    files = grading.specification([check for check in checks if check.is_file()])
    asked = repr([homework.name, homework.tasks, conditions.tier, conditions.secret, conditions.timeout])
    return [
        journal.Piece(team, one.path, journal.key(one.digest, files, asked)) for team, one in handins.items()
    ]


def points(graded: Mapping[str, Result]) -> dict[str, float]:
    """Return the points of each team's work."""
    return {team: result.score for team, result in graded.items()}


def page(homework: Homework, graded: Iterable[Result], notes: Iterable[str]) -> str:
    """Return the class page: how many hold each promise, and which misconceptions were met."""
    each = list(graded)
    promises = {(one.task, one.promise): [0, 0] for result in each for one in result.checks}
    for result in each:
        for one in result.checks:
            promises[one.task, one.promise][0] += one.outcome == "holds"
            promises[one.task, one.promise][1] += 1
    met = Counter((task, said) for result in each for task, said in result.misconceptions.items())
    scores = sorted(result.score for result in each)
    bins = Counter(min(9, int(10 * score / max(homework.points, 1e-9))) for score in scores)
    return (
        templates(Path(__file__).parent)
        .get_template(PAGE)
        .render(
            homework=homework,
            count=len(each),
            median=scores[len(scores) // 2] if scores else 0,
            bins=[(10 * k, bins[k]) for k in range(10)],
            promises=[(*key, holds, of) for key, (holds, of) in promises.items()],
            met=met.most_common(),
            notes=list(notes),
        )
    )
