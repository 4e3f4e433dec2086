"""What is written about a whole class, when its submissions are graded.

gradebook.csv   a row for each student: points, days late, penalty, score
canvas.csv      the scores, as Canvas imports them; moodle.csv, as Moodle's gradebook does
what_if.csv     what each student's score would be, had the work come so many days late
class.html      how many hold each promise, which misconceptions were met, and where each student stands
"""

import statistics
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from hdrlab.course.classroom import jobs, marks, moodle
from hdrlab.course.classroom.handins import SubmissionScan
from hdrlab.course.classroom.marks import GradebookRow
from hdrlab.course.classroom.run import GradingContext
from hdrlab.course.plan import Homework
from hdrlab.course.reports import csv_tables, results
from hdrlab.show.pages.templates import render_page

PAGE = "class_page.html"
BINS = 10  # of the scores, each a tenth of the points


class ClassStatistics(NamedTuple):
    """What counts of a class's results.

    Attributes
    ----------
    points : of each team's work
    outcomes : of each promise, by task and its words: how often it holds, fails, or was not
        answered
    met : how often each misconception was met, by task and sentence
    refused : why nothing of a team's work could be checked, in words
    """

    points: dict[str, float]
    outcomes: dict[tuple[str, str], Counter[results.Outcome]]
    met: Counter[tuple[str, str]]
    refused: dict[str, str] = {}


def tally(each: Iterable[results.Result]) -> ClassStatistics:
    """Return what counts of results, each of which is looked at once and let go."""
    found = ClassStatistics({}, {}, Counter(), {})
    for result in each:
        found.points[result.student] = result.score
        if result.problems and all(one.kind == "missing" for one in result.checks):
            found.refused[result.student] = result.problems[0]
        found.met.update(result.misconceptions.items())
        for one in result.checks:
            found.outcomes.setdefault((one.task, one.promise), Counter())[one.outcome] += 1
    return found


def marks_of(
    course: GradingContext, found: SubmissionScan, counted: ClassStatistics
) -> list[GradebookRow]:
    """Return the gradebook's rows, with why a file was refused."""
    return marks.marks(
        course, found.submissions, counted.points, {**counted.refused, **found.refused}
    )


def write(
    out: Path,
    course: GradingContext,
    found: SubmissionScan,
    counted: ClassStatistics,
    lost: Sequence[str] = (),
) -> list[Path]:
    """Write all that is about the whole class, and return the files; a new one has its line here.

    Parameters
    ----------
    out : the folder of the results
    course, found, counted : by what, what was handed in, and what came of it
    lost : what could not be graded
    """
    rows = marks_of(course, found, counted)
    tables: dict[str, tuple[Sequence[str], Sequence[Sequence[csv_tables.Cell]]]] = {
        "gradebook.csv": (marks.COLUMNS, rows),
        "canvas.csv": marks.canvas(rows, course.homework),
        "moodle.csv": moodle.gradebook(rows, course.roster, course.homework),
        "what_if.csv": marks.what_if(course, counted.points),
    }
    files = [
        csv_tables.write_csv(out / name, *table, private=True) for name, table in tables.items()
    ]
    text = page(course.homework, counted, [*found.notes, *lost], rows)
    jobs.write_private_file(out / "class.html", text.encode())
    return [*files, out / "class.html"]


def histogram(scores: Iterable[float], whole: float) -> list[tuple[int, int]]:
    """Return from which percent of the points on, and how many of the scores, in BINS parts."""
    bins = Counter(min(BINS - 1, int(BINS * score / max(whole, 1e-9))) for score in scores)
    return [(100 // BINS * k, bins[k]) for k in range(BINS)]


def page(
    homework: Homework,
    counted: ClassStatistics,
    notes: Iterable[str] = (),
    rows: Sequence[GradebookRow] = (),
) -> str:
    """Return the class page; each row of the gradebook leads to what its student reads."""
    scores = counted.points.values()
    bins, median = histogram(scores, homework.points), statistics.median(scores) if scores else 0
    words = {
        "homework": homework,
        "counted": counted,
        "bins": bins,
        "median": median,
        "notes": list(notes),
    }
    return render_page(Path(__file__).parent, PAGE, rows=rows, **words)
