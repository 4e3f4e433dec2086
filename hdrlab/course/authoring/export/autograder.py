"""Grade a submission on Gradescope, and write results.json even if grading fails.

Gradescope throws the container away after each run, and namespaces cannot be nested in it. So the
sandbox tier is `container`.
"""

import json
import sys
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from typing import Any

from hdrlab.course import plan, sanitize
from hdrlab.course.grading import grader
from hdrlab.course.reports import gradebook
from hdrlab.course.students.late_days import days_late
from hdrlab.errors import InputError

GRADESCOPE_ROOT = Path("/autograder")
MAX_MESSAGE_CHARACTERS = 500


def main(root: Path = GRADESCOPE_ROOT, tier: str = "container") -> None:
    """Grade the submission below `root`, as Gradescope lays it out, and write its results."""
    try:
        data = graded(root, tier)
    # whatever it is, student and instructor read why, and Gradescope's queue goes on
    except Exception as error:
        message = f"The autograder could not grade this: {type(error).__name__}: {error}"
        output = sanitize.sanitize_line(message, MAX_MESSAGE_CHARACTERS)
        results = {"score": 0, "output": output, "output_format": "text"}
        data = f"{json.dumps(results)}\n".encode()
    (root / "results").mkdir(exist_ok=True)
    (root / "results" / "results.json").write_bytes(data)


def graded(root: Path, tier: str) -> bytes:
    """Grade the submitted notebook or Python file, and return the content of results.json."""
    source = root / "source"
    settings = json.loads((source / "settings.json").read_text(encoding="utf8"))
    homework = plan.read(source / "plan.toml").homeworks[settings["homework"]]
    secret = settings["secret"]
    hidden = source / "hidden"
    metadata = read_metadata(root)
    options = plan.GradingOptions(
        tier=tier,
        student=student(metadata) if secret else "",
        secret=secret,
        hidden=hidden if hidden.is_dir() else None,
        draw=False,  # results.json has no images
    )
    result = grader.grade(handed_in(root / "submission"), homework, options)
    lateness = describe_lateness(metadata)
    if lateness:
        result = replace(result, problems=(*result.problems, lateness))
    return gradebook.gradescope(result)


def read_metadata(root: Path) -> dict[str, Any]:
    """Return what Gradescope says about a submission. Without its file, there are no submitters."""
    file = root / "submission_metadata.json"
    if not file.is_file():  # as in a container that the instructor runs without Gradescope
        return {"users": []}
    metadata: dict[str, Any] = json.loads(file.read_text(encoding="utf8"))
    return metadata


def student(metadata: dict[str, Any]) -> str:
    """Return the submitters' addresses, sorted, as Gradescope's metadata states them.

    Examples
    --------
    >>> student({"users": [{"email": "bo@example.org"}, {"email": "ada@example.org"}]})
    'ada@example.org,bo@example.org'
    """
    addresses = [str(user["email"]) for user in metadata["users"]]
    return ",".join(sorted(addresses))


def describe_lateness(metadata: dict[str, Any]) -> str:
    """Return a sentence about a submission that Gradescope received late, or "".

    Gradescope states a due date of the assignment, and for a student with an extension another
    one. The latest of a group counts.

    Examples
    --------
    >>> due = {"due_date": "2027-03-01T23:59:00-08:00"}
    >>> describe_lateness({"created_at": "2027-03-03T01:00:00-08:00", "assignment": due, "users": []})
    'Received 2 days after the due date. No points are taken off for that here.'
    """
    assignments = [user.get("assignment") for user in metadata["users"]]
    assignments.append(metadata.get("assignment"))
    due_dates = [assignment.get("due_date") for assignment in assignments if assignment]
    times = [datetime.fromisoformat(due_date) for due_date in due_dates if due_date]
    if not times or "created_at" not in metadata:
        return ""
    days = days_late(max(times), datetime.fromisoformat(metadata["created_at"]))
    if days == 0:
        return ""
    count = "1 day" if days == 1 else f"{days} days"
    return f"Received {count} after the due date. No points are taken off for that here."


def handed_in(folder: Path) -> Path:
    """Return the only notebook of a folder, or else its only Python file; links do not count."""
    files = sorted(path for path in folder.iterdir() if path.is_file() and not path.is_symlink())
    for suffix in (".ipynb", ".py"):
        candidates = [path for path in files if path.suffix.lower() == suffix]
        if len(candidates) == 1:
            return candidates[0]
        if candidates:
            names = ", ".join(path.name for path in candidates)
            raise InputError(f"expected one {suffix} file, got {names}")
    raise InputError("expected a notebook, .ipynb, or a Python file, .py")


if __name__ == "__main__":
    arguments = sys.argv[1:]
    main(Path(arguments[0]) if arguments else GRADESCOPE_ROOT, *arguments[1:2])
