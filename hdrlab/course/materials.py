"""Where notebooks and assignments are, in a package or a clone, and a reader's copy."""

from pathlib import Path

from hdrlab.io import files

COURSE = Path(__file__).parent
# settings of JupyterLab: it saves the state of widgets, and shows no news
JUPYTER = COURSE / "jupyter"


def folder(name: str) -> Path:
    """Return the folder "notebooks" or "assignments", in the wheel or at the top of a clone.

    Raises
    ------
    FileNotFoundError
        Where neither is there, which means that the installation is damaged.
    """
    inside = COURSE / name
    beside = COURSE.parents[1] / name
    for path in (inside, beside):
        if path.is_dir():
            return path
    raise FileNotFoundError(f"no folder {name!r} in {inside} or {beside}; install hdrlab again")


def copy_course(target: Path) -> list[Path]:
    """Copy notebooks and assignments into folders of `target` and return the new files.

    A file that is there stays as it is: it belongs to the reader.
    """
    new = []
    for name in ("notebooks", "assignments"):
        (target / name).mkdir(parents=True, exist_ok=True)
        for notebook in sorted(folder(name).glob("*.ipynb")):
            copy = target / name / notebook.name
            if not copy.exists():
                files.write(copy, notebook.read_bytes())
                new.append(copy)
    return new
