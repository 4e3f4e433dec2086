"""Write the tables and the page about a whole class.

gradebook.csv   a row for each student: points, days late, penalty, score
canvas.csv      the scores, as Canvas imports them; moodle.csv, as Moodle's gradebook does
what_if.csv     what each student's score would be for 0, 1, 2, ... days late
class.html      how many pass each check, common misconceptions, and the score of each student
"""

import statistics
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from hdrlab.course.classroom import jobs, marks, moodle
from hdrlab.course.classroom.marks import GradebookRow
from hdrlab.course.classroom.run import GradingContext
from hdrlab.course.grading import results
from hdrlab.course.plan import Homework
from hdrlab.course.students import csv_tables
from hdrlab.course.submissions.class_folder import SubmissionScan
from hdrlab.show.pages.templates import render_page

PAGE_TEMPLATE = "class_page.html"
HISTOGRAM_BINS = 10


@dataclass
class ClassStatistics:
    """What the results of a class add up to.

    Attributes
    ----------
    points : of each team's work
    outcomes : of each check, by its task and promise: how often it holds, fails, has no
        answer, or is broken itself
    misconceptions : how often each misconception was found, by task and sentence
    refused : by team, why no function of a submission could be checked
    """

    points: dict[str, float] = field(default_factory=dict)
    outcomes: dict[tuple[str, str], Counter[results.Outcome]] = field(default_factory=dict)
    misconceptions: Counter[tuple[str, str]] = field(default_factory=Counter)
    refused: dict[str, str] = field(default_factory=dict)


def collect_statistics(class_results: Iterable[results.Result]) -> ClassStatistics:
    """Return the statistics of a class. Each result is read once and not kept."""
    collected = ClassStatistics()
    for result in class_results:
        collected.points[result.student] = result.score
        if result.problems and all(check.kind == "missing" for check in result.checks):
            collected.refused[result.student] = result.problems[0]
        collected.misconceptions.update(result.misconceptions.items())
        for check in result.checks:
            outcomes = collected.outcomes.setdefault((check.task, check.promise), Counter())
            outcomes[check.outcome] += 1
    return collected


def gradebook_rows(
    context: GradingContext, scan: SubmissionScan, statistics: ClassStatistics
) -> list[GradebookRow]:
    """Return the rows of the gradebook; the notes say why a file was refused."""
    remarks = {**statistics.refused, **scan.refused}
    return marks.gradebook_rows(context, scan.submissions, statistics.points, remarks)


def write_class_files(
    out: Path,
    context: GradingContext,
    scan: SubmissionScan,
    statistics: ClassStatistics,
    failures: Sequence[str] = (),
) -> list[Path]:
    """Write all tables and the page about a class, and return the files; the page is the last.

    Parameters
    ----------
    out : the folder with the results of the class
    context : the roster, the homework and the rule for late submissions
    scan : the submissions
    statistics : see `collect_statistics`
    failures : about submissions that could not be graded
    """
    rows = gradebook_rows(context, scan, statistics)
    tables = {
        "gradebook.csv": (marks.COLUMNS, [row.cells for row in rows]),
        "canvas.csv": marks.canvas_table(rows, context.homework),
        "moodle.csv": moodle.gradebook(rows, context.roster, context.homework),
        "what_if.csv": marks.what_if_table(context, statistics.points),
    }
    paths = []
    for name, (header, lines) in tables.items():
        paths.append(csv_tables.write_csv(out / name, header, lines, private=True))
    page = class_page(context.homework, statistics, [*scan.notes, *failures], rows)
    page_path = out / "class.html"
    jobs.write_private_file(page_path, page.encode())
    return [*paths, page_path]


def histogram(scores: Iterable[float], max_score: float) -> list[tuple[int, int]]:
    """Count scores in ten bins of equal width; return (lowest percent, number) of each."""
    counts: Counter[int] = Counter()
    for score in scores:
        index = int(HISTOGRAM_BINS * score / max(max_score, 1e-9))
        counts[min(index, HISTOGRAM_BINS - 1)] += 1
    bin_percent = 100 // HISTOGRAM_BINS
    return [(bin_percent * k, counts[k]) for k in range(HISTOGRAM_BINS)]


def class_page(
    homework: Homework,
    class_statistics: ClassStatistics,
    notes: Iterable[str] = (),
    rows: Sequence[GradebookRow] = (),
) -> str:
    """Return the page about a class as HTML; each student's row links to their feedback."""
    scores = class_statistics.points.values()
    return render_page(
        Path(__file__).parent,
        PAGE_TEMPLATE,
        homework=homework,
        statistics=class_statistics,
        bins=histogram(scores, homework.points),
        median=statistics.median(scores) if scores else 0,
        notes=list(notes),
        rows=rows,
    )
