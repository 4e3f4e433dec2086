"""Where notebooks and assignments are, in a package or a clone, and a reader's copy."""

import shutil
from pathlib import Path

COURSE = Path(__file__).parents[1]
JUPYTER = (
    Path(__file__).parent / "jupyter"
)  # settings of JupyterLab: widgets are saved, news stay away


def folder(name: str) -> Path:
    """Return the folder "notebooks" or "assignments", in the wheel or at the top of a clone.

    Raises
    ------
    FileNotFoundError
        Where neither is there, which means that the installation is damaged.
    """
    inside, beside = COURSE / name, COURSE.parents[1] / name
    for place in (inside, beside):
        if place.is_dir():
            return place
    raise FileNotFoundError(
        f"expected the folder {name!r} in {inside} or {beside}; install hdrlab again"
    )


def copy_course(target: Path) -> list[Path]:
    """Copy notebooks and assignments into folders of `target` and return the new files.

    A file that is there stays as it is: it belongs to the reader.
    """
    new = []
    for name in ("notebooks", "assignments"):
        (target / name).mkdir(parents=True, exist_ok=True)
        each = [(one, target / name / one.name) for one in sorted(folder(name).glob("*.ipynb"))]
        new += [Path(shutil.copyfile(one, copy)) for one, copy in each if not copy.exists()]
    return new
