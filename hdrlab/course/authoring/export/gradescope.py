"""Export autograders for Gradescope: a zip with hdrlab, its checks, and the scripts that Gradescope runs.

The zip holds the library as it is installed here, so that Gradescope grades with the version that
the instructor has tried. It also holds the hidden checks and the secret of the course; students
never see the zip.
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

SKIPPED_SUFFIXES = (".pyc", ".ipynb")
# large files that no check needs
SKIPPED_FILES = ("scenes/chapel.exr", "scenes/street.exr", "scenes/workshop.exr")
# packages for reading notebooks in a browser, which no check needs and which take long to install
NOTEBOOK_PACKAGES = ("jupyterlab", "ipywidgets", "anywidget")
SCRIPTS_FOLDER = Path(__file__).parent / "gradescope_files"
EXECUTABLE_FILES = ("setup.sh", "run_autograder")


def export(
    plan: Plan,
    folder: Path,
    *,
    hidden: Path | None = None,
    plan_file: Path | None = None,
    secret: str = "",
) -> Iterator[Path]:
    """Write an autograder zip for each homework, and yield each once it is written.

    Parameters
    ----------
    plan : the homeworks
    folder : the folder, which is made if it is missing
    hidden : folder with the instructor's own checks
    plan_file : file of the plan, if it is not the package's
    secret : secret of the course, which draws each student's inputs; without it all get the same
    """
    folder.mkdir(parents=True, exist_ok=True)
    shared = dict(_library_files())
    for script in SCRIPTS_FOLDER.iterdir():
        shared[script.name] = script.read_bytes()
    shared["requirements.txt"] = "\n".join(requirements()).encode() + b"\n"
    shared["plan.toml"] = (plan_file or PLAN).read_bytes()
    hidden_checks = {}
    if hidden is not None:
        for path in sorted(hidden.glob("*.py")):
            hidden_checks[f"hidden/{path.name}"] = path.read_bytes()
    for name, homework in plan.homeworks.items():
        settings = json.dumps({"homework": name, "secret": secret})
        files = {**shared, "settings.json": settings.encode(), **hidden_checks}
        for task in homework.tasks:
            files.update(_own_task_files(task))
        yield write(folder / f"{name}_autograder.zip", make_zip(files, EXECUTABLE_FILES))


def _own_task_files(task: Task) -> Iterator[tuple[str, bytes]]:
    """Yield solution, checks and known mistakes of an instructor's own task, named from the plan."""
    if task.own is None:
        return
    home = task.own.parent
    mistakes = sorted(home.glob(f"mistakes/**/{task.id}_*.py"))
    for path in (task.own, home / f"test_{task.id}.py", *mistakes):
        yield path.relative_to(home).as_posix(), path.read_bytes()


def requirements() -> list[str]:
    """Return the packages that grading needs: those of hdrlab without its extras and notebooks."""
    return [
        requirement
        for requirement in requires("hdrlab") or ()
        if "extra ==" not in requirement and not requirement.startswith(NOTEBOOK_PACKAGES)
    ]


def _library_files() -> Iterator[tuple[str, bytes]]:
    """Yield hdrlab's files as an installed package has them, handouts included."""
    for path in LIBRARY.rglob("*"):
        name = path.relative_to(LIBRARY).as_posix()
        is_skipped = path.suffix in SKIPPED_SUFFIXES or name in SKIPPED_FILES
        if path.is_file() and not is_skipped:
            yield f"hdrlab/{name}", path.read_bytes()
    for path in materials.folder("assignments").glob("*.ipynb"):
        yield f"hdrlab/course/assignments/{path.name}", path.read_bytes()
