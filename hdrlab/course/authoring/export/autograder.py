"""Grade a submission on Gradescope, and write results.json even if grading fails.

Gradescope throws the container away after each run, and namespaces cannot be nested in it. So the
sandbox tier is `container`.
"""

import json
import sys
from pathlib import Path

from hdrlab.course import plan, sanitize
from hdrlab.course.grading import grader
from hdrlab.course.reports import gradebook
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
    options = plan.GradingOptions(
        tier=tier,
        student=student(root) if secret else "",
        secret=secret,
        hidden=hidden if hidden.is_dir() else None,
    )
    result = grader.grade(handed_in(root / "submission"), homework, options)
    return gradebook.gradescope(result)


def student(root: Path) -> str:
    """Return the submitters' addresses, sorted, as Gradescope's metadata states them."""
    metadata = json.loads((root / "submission_metadata.json").read_text(encoding="utf8"))
    addresses = [str(user["email"]) for user in metadata["users"]]
    return ",".join(sorted(addresses))


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
