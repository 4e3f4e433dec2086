"""Pack hdrlab and the packages that it needs into wheels, which a browser loads.

The packages are those of this environment, so nothing is downloaded, and the site has the versions
that its notebooks were run with. Compiled modules are left out: Pyodide brings NumPy, SciPy,
scikit-image, Pillow and matplotlib, and the other packages work without theirs.
"""

import hashlib
import zipfile
from importlib import metadata
from pathlib import Path, PurePosixPath

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from hdrlab import __version__
from hdrlab.course import materials

PACKAGE = Path(__file__).parents[3]
# compiled for WebAssembly by Pyodide
COMPILED = ("numpy", "scipy", "pillow", "matplotlib", "scikit-image")
# parts of ipywidgets that JupyterLite has already, and IPython with what it needs
PROVIDED = ("ipython", "jupyterlab-widgets", "traitlets", "widgetsnbextension")
BROWSER = {
    "sys_platform": "emscripten",
    "platform_system": "Emscripten",
    "os_name": "posix",
    "platform_machine": "wasm32",
    "python_version": "3.12",
    "python_full_version": "3.12.7",
    "extra": "",
}
COMPILED_SUFFIXES = (".so", ".pyd", ".pyc", ".dylib")
# wheels of the same files are the same bytes
DATE = (1980, 1, 1, 0, 0, 0)
WHEEL_METADATA = (
    "Wheel-Version: 1.0\nGenerator: hdrlab site\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
)


def write_wheels(folder: Path) -> list[Path]:
    """Write the wheels of hdrlab and of what it needs in a browser, and return their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    wheels = [_write_wheel(folder, "hdrlab", __version__, files_of_hdrlab())]
    for distribution in needed_distributions():
        name = canonicalize_name(distribution.name).replace("-", "_")
        files = files_of_distribution(distribution)
        wheels.append(_write_wheel(folder, name, distribution.version, files))
    return wheels


def digest_of(paths: list[Path]) -> str:
    """Return a short digest of the names and contents of files."""
    digest = hashlib.sha256()
    for path in sorted(paths):
        digest.update(path.name.encode() + hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()[:12]


def needed_distributions() -> list[metadata.Distribution]:
    """Return the installed distributions that hdrlab needs in a browser and Pyodide does not bring."""
    seen = {*COMPILED, *PROVIDED, "hdrlab"}
    distributions = []
    requirements = list(metadata.requires("hdrlab") or ())
    while requirements:
        requirement = Requirement(requirements.pop())
        name = canonicalize_name(requirement.name)
        is_wanted = requirement.marker is None or requirement.marker.evaluate(BROWSER)
        if name in seen or not is_wanted:
            continue
        seen.add(name)
        distribution = metadata.distribution(name)
        distributions.append(distribution)
        requirements += distribution.requires or ()
    return sorted(distributions, key=lambda distribution: canonicalize_name(distribution.name))


def files_of_distribution(distribution: metadata.Distribution) -> dict[str, bytes]:
    """Return the files of an installed distribution, without scripts and compiled modules."""
    files = {}
    for file in distribution.files or ():
        is_outside = ".." in file.parts or file.is_absolute()
        if not is_outside and file.suffix not in COMPILED_SUFFIXES and file.name != "RECORD":
            files[file.as_posix()] = file.read_binary()
    return files


def files_of_hdrlab() -> dict[str, bytes]:
    """Return the files of hdrlab's wheel, from an installation or from a clone."""
    files = {}
    for path in PACKAGE.rglob("*"):
        if path.is_file() and path.suffix not in COMPILED_SUFFIXES:
            files[path.relative_to(PACKAGE.parent).as_posix()] = path.read_bytes()
    for name in ("notebooks", "assignments"):
        for path in materials.folder(name).glob("*.ipynb"):
            files[f"hdrlab/course/{name}/{path.name}"] = path.read_bytes()
    requirements = "".join(f"Requires-Dist: {one}\n" for one in metadata.requires("hdrlab") or ())
    info = f"Metadata-Version: 2.1\nName: hdrlab\nVersion: {__version__}\n{requirements}"
    files[f"hdrlab-{__version__}.dist-info/METADATA"] = info.encode()
    files[f"hdrlab-{__version__}.dist-info/WHEEL"] = WHEEL_METADATA.encode()
    return files


def _write_wheel(folder: Path, name: str, version: str, files: dict[str, bytes]) -> Path:
    path = folder / f"{name}-{version}-py3-none-any.whl"
    [info] = {
        PurePosixPath(file).parts[0] for file in files if file.split("/")[0].endswith(".dist-info")
    }
    record = "".join(f"{file},,\n" for file in sorted(files)) + f"{info}/RECORD,,\n"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for file, content in sorted({**files, f"{info}/RECORD": record.encode()}.items()):
            archive.writestr(zipfile.ZipInfo(file, DATE), content, zipfile.ZIP_DEFLATED)
    return path
