"""What a sandbox contains: the interpreter, its libraries, numpy, scipy, and four files of hdrlab.

An interpreter keeps other packages in folders beside its own modules. `SandboxMounts.hidden` lists
those folders, and the sandbox shows them empty.
"""

import os
import platform
import sys
import sysconfig
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from hdrlab.course.sandbox.session import SUPERVISOR_PATH, package_folders

# folders inside the sandbox
PYTHON = "/python"
PACKAGES = "/packages"
COURSE = "/course"
OWN_FILES = ("supervisor.py", "worker.py", "channel.py", "system.py")
# patterns of the folders that hold other packages, relative to a folder of the interpreter
PACKAGE_FOLDER_PATTERNS = ("*-packages", "python*/*-packages")


@dataclass(frozen=True, kw_only=True)
class SandboxMounts:
    """The files and folders of a sandbox, by their paths inside.

    Attributes
    ----------
    prefix : the interpreter's home, outside
    python : the interpreter, inside
    places : what can be read: the path outside by the path inside, as in
        {"/python/lib": "/usr/local/lib"}
    hidden : folders inside of those places whose content is not shown
    packages : the folders of the packages, inside, by name
    """

    prefix: str
    python: str
    places: dict[str, str]
    hidden: tuple[str, ...]
    packages: dict[str, str]

    @property
    def program(self) -> str:
        """The path of supervisor.py, inside."""
        return f"{COURSE}/{SUPERVISOR_PATH.name}"

    def allowed_paths(self) -> tuple[list[str], list[str]]:
        """Return paths outside that together hold all places and nothing that is hidden.

        Returns
        -------
        listable : list of str
            Folders to list only, because a folder somewhere in them is hidden.
        readable : list of str
            Files to read, and folders to read with all that they contain.
        """
        listable = []
        readable = set()
        waiting = list(self.places.items())
        while waiting:
            place, source = waiting.pop()
            if place in self.hidden:
                continue
            contains_hidden = any(folder.startswith(f"{place}/") for folder in self.hidden)
            if contains_hidden:
                listable.append(source)
                names = os.listdir(source)
                waiting += [(f"{place}/{name}", f"{source}/{name}") for name in names]
                continue
            path = os.path.realpath(source)
            if os.path.exists(path):
                readable.add(path)
        return listable, sorted(readable)


@cache
def contents() -> SandboxMounts:
    """Return what a sandbox needs to run this interpreter with its numpy and scipy."""
    prefix = os.path.realpath(sys.base_prefix)
    binary = os.path.realpath(getattr(sys, "_base_executable", sys.executable))
    python = f"{PYTHON}/bin/python3"
    stdlib = os.path.relpath(os.path.realpath(sysconfig.get_path("stdlib")), prefix)
    places = _system_libraries()
    places[python] = binary
    places[f"{PYTHON}/{stdlib}"] = f"{prefix}/{stdlib}"
    # conda keeps all shared libraries in the folder that contains the standard library
    if os.path.isdir(f"{prefix}/conda-meta"):
        libraries = os.path.dirname(stdlib)
        places[f"{PYTHON}/{libraries}"] = f"{prefix}/{libraries}"
    for library in Path(prefix, "lib").glob("libpython*.so*"):
        places[f"{PYTHON}/lib/{library.name}"] = os.path.realpath(library)
    packages = {}
    for name, folder in package_folders().items():
        packages[name] = _place_of_package(folder)
        # a wheel keeps its shared libraries in a second folder
        for path in (folder, f"{folder}.libs"):
            if os.path.isdir(path):
                places[_place_of_package(path)] = path
    for name in OWN_FILES:
        places[f"{COURSE}/{name}"] = str(SUPERVISOR_PATH.with_name(name))
    return SandboxMounts(
        prefix=prefix,
        python=python,
        places=places,
        hidden=tuple(_find_package_folders(places)),
        packages=packages,
    )


def _place_of_package(folder: str) -> str:
    """Return the path inside of a package's folder."""
    return f"{PACKAGES}/{os.path.basename(folder)}"


def _system_libraries() -> dict[str, str]:
    """Return the folders of the system's shared libraries, under the names that the loader uses."""
    triplet = sysconfig.get_config_var("MULTIARCH") or f"{platform.machine()}-linux-gnu"
    names = [f"/lib/{triplet}", f"/usr/lib/{triplet}"]
    has_folders_by_processor = any(os.path.isdir(folder) for folder in names)
    names += ["/lib64", "/usr/lib64"]
    if not has_folders_by_processor:
        names += ["/lib", "/usr/lib"]
    # a numpy that belongs to the system finds its BLAS by these
    names += ["/etc/ld.so.cache", "/etc/alternatives"]
    return {name: os.path.realpath(name) for name in names if os.path.exists(name)}


def _find_package_folders(places: dict[str, str]) -> list[str]:
    """Return the folders inside that hold other packages than numpy and scipy."""
    folders = set()
    for inside, outside in places.items():
        if inside.startswith(PACKAGES) or not os.path.isdir(outside):
            continue
        for pattern in PACKAGE_FOLDER_PATTERNS:
            for folder in Path(outside).glob(pattern):
                folders.add(f"{inside}/{folder.relative_to(outside)}")
    return sorted(folders)
