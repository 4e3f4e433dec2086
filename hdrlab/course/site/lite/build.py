"""Put JupyterLite beside the pages of the site, with hdrlab's wheels and the notebooks.

lite/files/EDITION    the notebooks and assignments; the edition is a digest of them
lite/wheels/DIGEST    hdrlab and the packages that it needs
lite/pyodide          Pyodide, if it is served from a folder
lite/try, try.json    what the boxes "Try it" and the reader's own photos load, see `checks`

JupyterLite shows the copy of a file in the browser in place of the site's. So another edition has
other paths: a new notebook is never hidden by an old copy, and the old copy stays where it was.
"""

import hashlib
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterable, Sequence
from importlib import metadata
from pathlib import Path
from typing import Any, NamedTuple

from packaging.utils import canonicalize_name

from hdrlab.course.authoring.execute import library_key
from hdrlab.course.site.lite import checks, wheels
from hdrlab.errors import InputError

HERE = Path(__file__).parent
KERNEL_DISTRIBUTION = "jupyterlite-pyodide-kernel"
KERNEL = "@jupyterlite/pyodide-kernel-extension"
LABEXTENSIONS = "labextensions"
# extensions of JupyterLab: the kernel, sliders, and the widgets of hdrlab
EXTENSIONS = (KERNEL, "@jupyter-widgets/jupyterlab-manager", "anywidget")
# `lite.js` reads this storage, too
STORAGE_NAME = "hdrlab notebooks"
# from the worker of the kernel, which loads the wheels, to the folder lite
LITE_FROM_WORKER = "../../../../"
CORE_FILES = (
    "pyodide.js",
    "pyodide.mjs",
    "pyodide.asm.js",
    "pyodide.asm.wasm",
    "python_stdlib.zip",
)
LOCK_FILE = "pyodide-lock.json"
# The service worker shows the browser's storage to Python as its working folder. Each import would
# look there first, and wait for the page: the first check would take minutes on a busy machine.
DISABLED = (
    "@jupyterlite/server-extension:service-worker",
    "@jupyterlite/server-extension:emscripten-filesystem",
)
# what the kernel of JupyterLite loads
KERNEL_PACKAGES = ("micropip", "ssl", "sqlite3", "ipython")
NOTEBOOK_PACKAGES = (*KERNEL_PACKAGES, *wheels.COMPILED)
# files whose bytes the worker of a box counts: it loads scripts in another way
LOADED_FILES = ("pyodide.asm.wasm", "python_stdlib.zip", LOCK_FILE)


class PyodideSource(NamedTuple):
    """Where browsers load Pyodide from.

    Attributes
    ----------
    url : address of `pyodide.js`; relative to the folder lite if the site has its own copy
    folder : the folder to copy; None if Pyodide is loaded from elsewhere
    lacking : packages of notebooks that the folder lacks
    """

    url: str
    folder: Path | None
    lacking: tuple[str, ...]


def edition_of(notebooks: Sequence[Path], handouts: Sequence[Path]) -> str:
    """Return the edition of notebooks and assignments: a digest of their names and contents."""
    return wheels.digest_of([*notebooks, *handouts])[:8]


def find_pyodide(place: str) -> PyodideSource:
    """Return where Pyodide is: at an address, or in a folder, which is checked.

    Raises
    ------
    InputError
        If the folder has no Pyodide, or a version that does not fit JupyterLite's kernel.
    """
    from jupyterlite_pyodide_kernel.constants import PYODIDE_VERSION

    if place.startswith(("https://", "http://")):
        address = place if place.endswith(".js") else place.rstrip("/") + "/pyodide.js"
        return PyodideSource(address, None, ())
    folder = Path(place).resolve()
    missing = [name for name in (*CORE_FILES, LOCK_FILE) if not (folder / name).is_file()]
    if missing:
        raise InputError(f"--lite: no Pyodide in {folder}: {', '.join(missing)} missing")
    lock = json.loads((folder / LOCK_FILE).read_text("utf8"))
    version = lock["info"]["version"]
    if version.split(".")[:2] != PYODIDE_VERSION.split(".")[:2]:
        raise InputError(
            f"--lite: the installed jupyterlite-pyodide-kernel needs Pyodide {PYODIDE_VERSION}, "
            f"and {folder} has {version}"
        )
    present = _needed_packages(lock, folder, NOTEBOOK_PACKAGES)
    lacking = tuple(name for name in wheels.COMPILED if name not in present)
    return PyodideSource("./pyodide/pyodide.js", folder, lacking)


def build(
    out: Path,
    cache: Path,
    notebooks: Sequence[Path],
    handouts: Sequence[Path],
    pyodide: PyodideSource,
) -> None:
    """Build the folder `lite` of the site in `out`; if nothing has changed, it is left as it is."""
    edition = edition_of(notebooks, handouts)
    packages = [metadata.distribution(name) for name in ("jupyterlite-core", KERNEL_DISTRIBUTION)]
    packages += wheels.needed_distributions()
    versions = [f"{package.name} {package.version}" for package in packages]
    key = f"{library_key(course=True)} {edition} {pyodide} {versions}"
    record = cache / "lite.txt"
    target = out / "lite"
    if target.exists() and record.exists() and record.read_text("utf8") == key:
        return
    record.unlink(missing_ok=True)
    source = cache / "lite-source"
    made = cache / "lite"
    for folder in (source, made):
        shutil.rmtree(folder, ignore_errors=True)
    _write_source(source, edition, notebooks, handouts)
    _run_jupyterlite(source, made)
    packed = wheels.write_wheels(made / "wheels" / "new")
    digest = wheels.digest_of(packed)
    (made / "wheels" / "new").rename(made / "wheels" / digest)
    names = [f"{LITE_FROM_WORKER}wheels/{digest}/{wheel.name}" for wheel in packed]
    if pyodide.folder is not None:
        _copy_pyodide(pyodide.folder, made / "pyodide")
    compiled = [name for name in wheels.COMPILED if name not in pyodide.lacking]
    checks.write(made, pyodide.url, _sizes_for_checks(pyodide.folder))
    _configure(made / "jupyter-lite.json", pyodide.url, [*names, *KERNEL_PACKAGES, *compiled])
    shutil.rmtree(target, ignore_errors=True)
    # with times of today: JupyterLite's are of 1985, and a browser would keep such a file for years
    shutil.copytree(made, target, copy_function=shutil.copyfile)
    shutil.rmtree(made)
    record.write_text(key, "utf8")


def remove(out: Path) -> None:
    """Remove JupyterLite of an earlier build, whose notebooks no page leads to any more."""
    shutil.rmtree(out / "lite", ignore_errors=True)


def _write_source(
    source: Path, edition: str, notebooks: Sequence[Path], handouts: Sequence[Path]
) -> None:
    """Write the folder that JupyterLite is built from."""
    for name, files in {"notebooks": notebooks, "assignments": handouts}.items():
        folder = source / "files" / edition / name
        folder.mkdir(parents=True)
        for file in files:
            shutil.copyfile(file, folder / file.name)
    shutil.copyfile(HERE / "settings.json", source / "overrides.json")
    shutil.copytree(HERE / "download", source / LABEXTENSIONS / "hdrlab-download")
    for name in EXTENSIONS:
        shutil.copytree(_find_extension(name), source / LABEXTENSIONS / name)


def _find_extension(name: str) -> Path:
    """Return the folder of an installed extension of JupyterLab."""
    from jupyter_core.paths import jupyter_path

    for folder in jupyter_path(LABEXTENSIONS):
        if (Path(folder) / name / "package.json").exists():
            return Path(folder) / name
    raise InputError(f'--lite: no extension {name} of JupyterLab; run: pip install "hdrlab[lite]"')


def _run_jupyterlite(source: Path, made: Path) -> None:
    """Build JupyterLite's apps for notebooks, without the settings of this computer's user."""
    command = [sys.executable, "-m", "jupyterlite_core", "build"]
    # notebooks, and the list of files behind "Open..." in their menu
    command += ["--apps=notebooks", "--apps=tree"]
    command += ["--no-sourcemaps", "--no-unused-shared-packages", "--ignore-sys-prefix"]
    command += [f"--FederatedExtensionAddon.extra_labextensions_path={source / LABEXTENSIONS}"]
    command += [f"--lite-dir={source}", f"--output-dir={made}"]
    environment = os.environ | {"JUPYTER_NO_CONFIG": "1"}
    result = subprocess.run(command, cwd=source, env=environment, capture_output=True, text=True)
    if result.returncode != 0:
        raise RuntimeError(f"JupyterLite could not be built:\n{result.stdout}{result.stderr}")


def _configure(path: Path, pyodide_url: str, packages: list[str]) -> None:
    """Tell JupyterLite where Pyodide and the wheels are, and where it keeps notebooks."""
    settings = json.loads(path.read_text("utf8"))
    config = settings["jupyter-config-data"]
    config["appName"] = "hdrlab"
    config["appUrl"] = "./notebooks"
    config["contentsStorageName"] = STORAGE_NAME
    config["disabledExtensions"] = list(DISABLED)
    config["litePluginSettings"][f"{KERNEL}:kernel"] |= {
        "pyodideUrl": pyodide_url,
        "disablePyPIFallback": True,
        "loadPyodideOptions": {"packages": packages},
    }
    path.write_text(json.dumps(settings, indent=1), "utf8")


def _sizes_for_checks(folder: Path | None) -> dict[str, int]:
    """Return the bytes of Pyodide that a check loads at first, and those of each further package.

    They are unknown, {}, if Pyodide is loaded from elsewhere.
    """
    if folder is None:
        return {}
    lock = json.loads((folder / LOCK_FILE).read_text("utf8"))

    def size(files: Iterable[str]) -> int:
        return sum((folder / name).stat().st_size for name in files)

    def files_of(names: Sequence[str]) -> set[str]:
        needed = _needed_packages(lock, folder, names)
        return {package["file_name"] for package in needed.values()}

    first = files_of(checks.PACKAGES)
    further = {name: size(files_of([name]) - first) for name in wheels.COMPILED}
    return {"start": size([*LOADED_FILES, *first]), **further}


def _needed_packages(lock: dict[str, Any], folder: Path, names: Sequence[str]) -> dict[str, Any]:
    """Return packages of Pyodide with those that they need, as far as the folder has them."""
    needed: dict[str, Any] = {}
    names = list(names)
    while names:
        name = canonicalize_name(names.pop())
        package = lock["packages"].get(name)
        if name not in needed and package and (folder / package["file_name"]).is_file():
            needed[name] = package
            names += package["depends"]
    return needed


def _copy_pyodide(folder: Path, target: Path) -> None:
    """Copy Pyodide with the packages that notebooks load, and verify their checksums."""
    target.mkdir()
    lock = json.loads((folder / LOCK_FILE).read_text("utf8"))
    needed = _needed_packages(lock, folder, NOTEBOOK_PACKAGES)
    for package in needed.values():
        content = (folder / package["file_name"]).read_bytes()
        if hashlib.sha256(content).hexdigest() != package["sha256"]:
            raise InputError(f"--lite: {folder / package['file_name']} is damaged: copy it again")
        (target / package["file_name"]).write_bytes(content)
    for name in CORE_FILES:
        shutil.copyfile(folder / name, target / name)
    (target / LOCK_FILE).write_text(json.dumps(lock | {"packages": needed}), "utf8")
