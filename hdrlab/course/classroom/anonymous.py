"""Write what an anonymous reader of a class opens: pages and tables with codes instead of names.

OUT/anonymous/
  class.html        the page about the class, with links to the feedback
  feedback/         for each team, the feedback page
  submissions/      for each team, its code and text as a Python file, without outputs
  gradebook.csv     points, late days and scores
  points.csv        a table to fill in: points and comments by hand, for `--adjustments`

Files are written in the order of the codes, so that neither a row nor a time tells the order of the
roster.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from hdrlab.course.classroom import jobs, marks, overview
from hdrlab.course.classroom.marks import GradebookRow
from hdrlab.course.classroom.overview import ClassStatistics
from hdrlab.course.grading import results
from hdrlab.course.plan import Homework
from hdrlab.course.reports import feedback
from hdrlab.course.students import csv_tables
from hdrlab.course.students.anonymity import WORD, Anonymity
from hdrlab.course.submissions import reader
from hdrlab.course.submissions.class_folder import Submission

FOLDER = "anonymous"
POINTS_COLUMNS = ("student", "points", "comment", "hold")


def write_class(
    out: Path,
    homework: Homework,
    rows: Sequence[GradebookRow],
    statistics: ClassStatistics,
    class_results: Iterable[results.Result],
    submissions: Mapping[str, Submission],
    notes: Iterable[str],
    anonymity: Anonymity,
) -> Path:
    """Write the anonymous folder of a class, and return its page.

    An existing points.csv stays: a reader may have filled it in.

    Parameters
    ----------
    out : the folder with the results of the class
    homework : the assignment
    rows : of the gradebook, with names
    statistics : see `overview.collect_statistics`
    class_results : the result of each team
    submissions : by team
    notes : about files and failures, with names
    anonymity : the codes of the class
    """
    folder = out / FOLDER
    for path in (folder, folder / "feedback", folder / "submissions"):
        jobs.make_private(path)
    pages = {}
    for result in class_results:
        hidden = hide_result(result, anonymity)
        pages[hidden.student] = feedback.page(hidden)
    for code, page in sorted(pages.items()):
        jobs.make_private(folder / "feedback" / code)
        jobs.write_private_file(folder / "feedback" / code / "feedback.html", page.encode())
    for team in sorted(submissions, key=anonymity.teams.__getitem__):
        text = anonymous_text(submissions[team].path, homework.name, anonymity)
        path = folder / "submissions" / f"{anonymity.teams[team]}.py"
        jobs.write_private_file(path, text.encode())
    hidden_rows = sorted(
        (hide_row(row, anonymity) for row in rows), key=lambda row: (row.team, row.student)
    )
    lines = [row.cells for row in hidden_rows]
    csv_tables.write_csv(folder / "gradebook.csv", marks.COLUMNS, lines, private=True)
    if not (folder / "points.csv").exists():
        empty = [[row.student, "", "", ""] for row in hidden_rows]
        csv_tables.write_csv(folder / "points.csv", POINTS_COLUMNS, empty, private=True)
    hidden_notes = sorted(anonymity.redact(note) for note in notes)
    page = overview.class_page(homework, statistics, hidden_notes, hidden_rows)
    jobs.write_private_file(folder / "class.html", page.encode())
    return folder / "class.html"


def hide_result(result: results.Result, anonymity: Anonymity) -> results.Result:
    """Return a result under the code of its team, without names in what the submission says."""
    return replace(
        result,
        student=anonymity.teams[result.student],
        problems=tuple(anonymity.redact(problem) for problem in result.problems),
        checks=tuple(_hide_check(check, anonymity) for check in result.checks),
    )


def _hide_check(check: results.Check, anonymity: Anonymity) -> results.Check:
    return replace(
        check,
        message=anonymity.redact(check.message),
        printed=anonymity.redact(check.printed),
        counterexample=_redact_counterexample(check.counterexample, anonymity),
        drawing=check.drawing._replace(
            alts=tuple(anonymity.redact(alt) for alt in check.drawing.alts),
            captions=tuple(anonymity.redact(caption) for caption in check.drawing.captions),
        ),
    )


def _redact_counterexample(
    counterexample: results.Counterexample | None, anonymity: Anonymity
) -> results.Counterexample | None:
    """Return a counterexample without names, which a student's answer or error may contain."""
    if counterexample is None:
        return None
    return results.Counterexample(*(anonymity.redact(text) for text in counterexample))


def hide_row(row: GradebookRow, anonymity: Anonymity) -> GradebookRow:
    """Return a row of the gradebook with codes instead of names."""
    return replace(
        row,
        student=anonymity.students[row.student],
        name="",
        team=anonymity.teams[row.team],
        note=anonymity.redact(row.note),
        comment=anonymity.redact(row.comment),
    )


def anonymous_text(path: Path, homework: str, anonymity: Anonymity) -> str:
    """Return a submission as a Python file in the percent format, without names and outputs."""
    parts = []
    for cell in reader.read_text(path, homework):
        text = anonymity.redact_code(cell.text) if cell.is_code else anonymity.redact(cell.text)
        parts.append(f"{cell.header}\n{text}" if cell.header else text)
    return "\n\n".join(parts) + "\n"


def words_of_assignment(homework: str) -> set[str]:
    """Return the words of an assignment, which are also ordinary words if they are names."""
    return {word for cell in reader.assignment_cells(homework) for word in WORD.findall(cell.text)}
