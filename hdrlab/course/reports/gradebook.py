"""Write a Result in the formats that other programs read: Gradescope, JUnit and a spreadsheet.

Text from students cannot break them: XML has no control characters, and no cell is a formula.
"""

import json
from pathlib import Path
from typing import Any

from hdrlab.course.grading import results, scoring
from hdrlab.course.reports import feedback
from hdrlab.course.students import csv_tables
from hdrlab.io.files import write

COLUMNS = ("student", "homework", "tier", "score", "max_score")
FILES = ("result.json", "gradescope.json", "junit.xml", "result.csv", "feedback.html")
RECEIPT_FILE = "receipt.txt"


def gradescope(result: results.Result) -> bytes:
    """Return results.json as Gradescope's autograder expects it, with a test for each check.

    The outcome of a hidden check is shown once grades are published. Why it failed is never shown.
    """
    output = list(result.problems)
    if not result.for_credit:
        output.append(f"For practice. {result.why_practice}")
    report = {
        "score": result.score,
        "output": "\n".join(output),
        "output_format": "text",
        "visibility": "visible",
        "stdout_visibility": "hidden",
        "tests": [_gradescope_test(result, check) for check in result.checks],
    }
    return json.dumps(report, indent=1).encode()


def _gradescope_test(result: results.Result, check: results.Check) -> dict[str, Any]:
    """Return a check as a test in Gradescope's results.json."""
    score, max_score = results.points((check,))
    message = ""
    if not check.hidden:
        message = check.message
        mistake = result.misconceptions.get(check.task)
        if message and mistake:
            message = f"{message}\nLikely mistake: {mistake}"
    return {
        "name": f"{check.task}: {check.promise}",
        "score": score,
        "max_score": max_score,
        "status": "passed" if check.outcome in scoring.COSTLESS_OUTCOMES else "failed",
        "output": message,
        "output_format": "text",
        "visibility": "after_published" if check.hidden else "visible",
    }


def junit(result: results.Result) -> bytes:
    """Return JUnit's XML, with a suite for each task and a case for each check."""
    return feedback.environment().get_template("junit.xml").render(result=result).encode()


def table(result: results.Result) -> str:
    """Return a Result as CSV, with a header and one row: its total and the points of each task."""
    row: list[str | int | float | None] = []
    row += [result.student, result.homework, result.tier, result.score, result.max_score]
    row += [results.points(result.of(task))[0] for task in result.tasks]
    return csv_tables.csv_text([*COLUMNS, *result.tasks], [row])


def write_results(
    folder: Path, result: results.Result, team_json: bytes | None = None, receipt: str = ""
) -> list[Path]:
    """Write a Result in all formats into a folder, and return the files.

    Only the owner of the files can read them. The JSON is written last: if it exists, so do all
    the others. Without a receipt, the receipt of an earlier result is deleted.

    Parameters
    ----------
    folder : created if it does not exist
    result : Result
    team_json : what result.json holds; by default, the whole Result
    receipt : the line that `receipts.sign` returned for the Result, or ""
    """
    contents = {
        "gradescope.json": gradescope(result),
        "junit.xml": junit(result),
        "result.csv": table(result).encode(),
        "feedback.html": feedback.page(result, receipt=receipt).encode(),
    }
    if receipt:
        contents[RECEIPT_FILE] = f"{receipt}\n".encode()
    contents["result.json"] = results.to_json(result) if team_json is None else team_json
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    if not receipt:
        (folder / RECEIPT_FILE).unlink(missing_ok=True)
    for name, data in contents.items():
        write(folder / name, data, private=True)
    files = [folder / name for name in FILES]
    if receipt:
        files.append(folder / RECEIPT_FILE)
    return files
