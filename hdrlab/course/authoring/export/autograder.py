"""What runs on Gradescope: grade what was handed in, and write results.json whatever happens.

The container is thrown away after each run, and namespaces cannot nest in it; so the tier is
`container`.
"""

import json
import sys
from pathlib import Path

from hdrlab.course import plan, sanitize
from hdrlab.course.grading import grader
from hdrlab.course.reports import gradebook
from hdrlab.errors import InputError

ROOT = Path("/autograder")


def main(root: Path = ROOT, tier: str = "container") -> None:
    """Grade the submission below `root`, as Gradescope lays it out, and write its results."""
    try:
        data = graded(root, tier)
    except (
        Exception
    ) as error:  # whatever it is: student and instructor are told, and the queue goes on
        said = sanitize.sanitize_line(
            f"The autograder could not grade this: {type(error).__name__}: {error}", 500
        )
        data = (json.dumps({"score": 0, "output": said, "output_format": "text"}) + "\n").encode()
    (root / "results").mkdir(exist_ok=True)
    (root / "results" / "results.json").write_bytes(data)


def graded(root: Path, tier: str) -> bytes:
    """Return results.json of the one notebook, or Python file, that was handed in."""
    source = root / "source"
    settings = json.loads((source / "settings.json").read_text(encoding="utf8"))
    homework = plan.read(source / "plan.toml").homeworks[settings["homework"]]
    hidden, secret = source / "hidden", settings["secret"]
    who = student(root) if secret else ""
    conditions = plan.GradingOptions(tier, who, secret, hidden if hidden.is_dir() else None)
    return gradebook.gradescope(grader.grade(handed_in(root / "submission"), homework, conditions))


def student(root: Path) -> str:
    """Return who handed it in, by the address that Gradescope knows."""
    metadata = json.loads((root / "submission_metadata.json").read_text(encoding="utf8"))
    return ",".join(sorted(str(one["email"]) for one in metadata["users"]))


def handed_in(folder: Path) -> Path:
    """Return the only notebook of a folder, or else its only Python file; a link is neither."""
    files = sorted(one for one in folder.iterdir() if one.is_file() and not one.is_symlink())
    for suffix in (".ipynb", ".py"):
        fitting = [one for one in files if one.suffix.lower() == suffix]
        if len(fitting) == 1:
            return fitting[0]
        if fitting:
            raise InputError(
                f"expected one {suffix} file, got {', '.join(one.name for one in fitting)}"
            )
    raise InputError("expected a notebook, .ipynb, or a Python file, .py")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT, *sys.argv[2:3])
