"""Where the notebooks and the specification are, in an installed package or a clone, and a reader's copy."""

import shutil
from pathlib import Path


def folder(name: str) -> Path:
    """Return the folder "notebooks" or "tests", as it travels in the wheel or stands at the top of a clone.

    Raises
    ------
    FileNotFoundError
        Where neither is there, which means that the installation is damaged.
    """
    inside, beside = Path(__file__).parent / name, Path(__file__).parents[2] / name
    for place in (inside, beside):
        if place.is_dir():
            return place
    raise FileNotFoundError(f"expected the folder {name!r} in {inside} or {beside}; install hdrlab again")


def copy_notebooks(target: Path) -> list[Path]:
    """Copy the notebooks into `target` and return the new files; a notebook that is there stays as it is."""
    target.mkdir(parents=True, exist_ok=True)
    missing = [one for one in sorted(folder("notebooks").glob("*.ipynb")) if not (target / one.name).exists()]
    return [Path(shutil.copyfile(one, target / one.name)) for one in missing]
