"""An autograder for Gradescope: a zip with this very hdrlab, its checks, and scripts to set up and to run.

The zip holds the library as it is installed here, so that what grades is what was tried. The hidden
checks and the secret in it are for the instructor's eyes: students never see the zip.
"""

import json
from collections.abc import Iterator
from importlib.metadata import requires
from pathlib import Path

from hdrlab.course import materials
from hdrlab.course.plan import PLAN, Plan, Task
from hdrlab.course.sandbox.subprocess_runner import LIBRARY
from hdrlab.course.submissions.archives.packing import make_zip
from hdrlab.io.files import write

SKIPPED = (".pyc", ".ipynb")
LARGE = ("scenes/chapel.exr", "scenes/street.exr", "scenes/workshop.exr")  # no check needs them
SCRIPTS = Path(__file__).parent / "gradescope_files"  # which Gradescope runs
PROGRAMS = ("setup.sh", "run_autograder")


def export(
    plan: Plan,
    folder: Path,
    *,
    hidden: Path | None = None,
    plan_file: Path | None = None,
    secret: str = "",
) -> Iterator[Path]:
    """Write an autograder zip for each homework, and yield each when it is there.

    Parameters
    ----------
    plan : what is in each homework
    folder : made where it is missing
    hidden : folder with checks of the instructor's own
    plan_file : the plan's file, where it is not the package's
    secret : the course's, from which each student's inputs are drawn; without it all get the same
    """
    folder.mkdir(parents=True, exist_ok=True)
    library, own = dict(_library()), sorted(hidden.glob("*.py")) if hidden else []
    for name in plan.homeworks:
        files = {
            **library,
            **{script.name: script.read_bytes() for script in SCRIPTS.iterdir()},
            "requirements.txt": "\n".join(requirements()).encode() + b"\n",
            "plan.toml": (plan_file or PLAN).read_bytes(),
            "settings.json": json.dumps({"homework": name, "secret": secret}).encode(),
            **{f"hidden/{one.name}": one.read_bytes() for one in own},
            **{name: data for task in plan.homeworks[name].tasks for name, data in _own(task)},
        }
        yield write(folder / f"{name}_autograder.zip", make_zip(files, PROGRAMS))


def _own(task: Task) -> Iterator[tuple[str, bytes]]:
    """Yield the files of a task that is not hdrlab's, beside the plan: solution, checks and mistakes."""
    if task.own is not None:
        home = task.own.parent
        mistakes = sorted(home.glob(f"mistakes/**/{task.id}_*.py"))
        for file in (task.own, home / f"test_{task.id}.py", *mistakes):
            yield file.relative_to(home).as_posix(), file.read_bytes()


def requirements() -> list[str]:
    """Return what hdrlab needs to run, without its extras."""
    return [one for one in requires("hdrlab") or () if "extra ==" not in one]


def _library() -> Iterator[tuple[str, bytes]]:
    """Yield hdrlab's files as they stand in an installed package: handouts inside of it."""
    for file in LIBRARY.rglob("*"):
        name = file.relative_to(LIBRARY).as_posix()
        if file.is_file() and file.suffix not in SKIPPED and name not in LARGE:
            yield f"hdrlab/{name}", file.read_bytes()
    for file in materials.folder("assignments").glob("*.ipynb"):
        yield f"hdrlab/course/assignments/{file.name}", file.read_bytes()
