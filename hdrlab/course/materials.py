"""Where notebooks and assignments are, in a package or a clone, and a reader's copy."""

import hashlib
import json
from pathlib import Path

from hdrlab.io import files

COURSE = Path(__file__).parent
# configuration of a Jupyter server: JupyterLab saves the state of widgets and shows no news, and an
# extension runs hdrlab's own notebooks when they are opened
JUPYTER = COURSE / "jupyter"
LAB_EXTENSIONS = JUPYTER / "labextensions"
# a workspace of JupyterLab that shows the table of contents
WORKSPACE = JUPYTER / "workspace.json"


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


def code_digests() -> list[str]:
    """Return the SHA-256 digest of the code of each notebook; the extension of `hdrlab lab` compares them."""
    digests = []
    for notebook in sorted(folder("notebooks").glob("*.ipynb")):
        cells = json.loads(notebook.read_text("utf-8"))["cells"]
        sources = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
        digests.append(hashlib.sha256("\0".join(sources).encode()).hexdigest())
    return digests
