"""A Result in the forms that others read: Gradescope's results.json, JUnit's XML, a table for a spreadsheet.

Whatever a student wrote stays text in them: XML without control characters, cells that are no
formula.
"""

from pathlib import Path

from hdrlab.course.reports import csv_tables, feedback, results
from hdrlab.io.files import write

COLUMNS = ("student", "homework", "tier", "score", "max_score")
FILES = ("result.json", "gradescope.json", "junit.xml", "result.csv", "feedback.html")


def gradescope(result: results.Result) -> bytes:
    """Return results.json as Gradescope's autograder expects it: a test for each promise.

    Of a hidden check, the outcome is shown when grades are published, and why it failed never is.
    """
    return feedback.environment().get_template("gradescope.json").render(result=result).encode()


def junit(result: results.Result) -> bytes:
    """Return JUnit's XML: a suite for each task, a case for each promise."""
    return feedback.environment().get_template("junit.xml").render(result=result).encode()


def table(result: results.Result) -> str:
    """Return a Result as CSV, a header and a row: who, what, and the points of each task."""
    earned = [results.points(result.of(task))[0] for task in result.tasks]
    row = [*(getattr(result, name) for name in COLUMNS), *earned]
    return csv_tables.csv_text([*COLUMNS, *result.tasks], [row])


def write_results(folder: Path, result: results.Result, shown: bytes | None = None) -> list[Path]:
    """Write a Result in all forms into a folder, which is made where it is missing; return the files.

    The JSON is written last: where it is, all of it is. It is `shown` where a team is to read it,
    and the whole Result unless told. The files are for their owner's eyes.
    """
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    contents = {
        "gradescope.json": gradescope(result),
        "junit.xml": junit(result),
        "result.csv": table(result).encode(),
        "feedback.html": feedback.page(result).encode(),
        "result.json": results.to_json(result) if shown is None else shown,
    }
    for name, data in contents.items():
        write(folder / name, data, private=True)
    return [folder / name for name in FILES]
