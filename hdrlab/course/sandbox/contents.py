"""What a sandbox holds: the interpreter, the libraries it needs, numpy, scipy, and four files of ours.

An interpreter keeps other packages beside its own modules. They are left out: `SandboxMounts.hidden`
names those folders.
"""

import os
import platform
import sys
import sysconfig
from functools import cache
from pathlib import Path
from typing import NamedTuple

from hdrlab.course.sandbox.running import PROGRAM, packages

PYTHON, PACKAGES, COURSE = "/python", "/packages", "/course"  # where they are inside
OURS = ("supervisor.py", "worker.py", "channel.py", "system.py")


class SandboxMounts(NamedTuple):
    """Files and folders, by where they are inside: {"/python/lib": "/usr/local/lib", ...}.

    Attributes
    ----------
    prefix : the interpreter's home outside
    python : the interpreter inside
    places : what is to be read there
    hidden : folders inside of those, of which nothing is to be seen
    packages : the folders of the packages, inside
    """

    prefix: str
    python: str
    places: dict[str, str]
    hidden: tuple[str, ...]
    packages: dict[str, str]

    @property
    def program(self) -> str:
        """Where the supervisor is, inside."""
        return f"{COURSE}/{PROGRAM.name}"

    def readable(self) -> tuple[list[str], list[str]]:
        """Return folders to list and paths to read, outside, that hold all places and nothing hidden."""
        listed: list[str] = []
        read: list[str] = []
        waiting = [(place, source) for place, source in self.places.items()]
        while waiting:
            place, source = waiting.pop()
            if place in self.hidden:
                continue
            if any(folder.startswith(f"{place}/") for folder in self.hidden):
                listed.append(source)
                waiting += [(f"{place}/{name}", f"{source}/{name}") for name in os.listdir(source)]
            else:
                read.append(os.path.realpath(source))
        return listed, sorted(set(filter(os.path.exists, read)))


@cache
def contents() -> SandboxMounts:
    """Return what this interpreter and its numpy and scipy need."""
    prefix = os.path.realpath(sys.base_prefix)
    binary = os.path.realpath(getattr(sys, "_base_executable", sys.executable))
    python = f"{PYTHON}/bin/python3"
    stdlib = os.path.relpath(os.path.realpath(sysconfig.get_path("stdlib")), prefix)
    places = _libraries() | {python: binary, f"{PYTHON}/{stdlib}": f"{prefix}/{stdlib}"}
    if os.path.isdir(f"{prefix}/conda-meta"):  # it keeps all libraries beside its modules
        places[f"{PYTHON}/{os.path.dirname(stdlib)}"] = f"{prefix}/{os.path.dirname(stdlib)}"
    for library in Path(prefix, "lib").glob("libpython*.so*"):
        places[f"{PYTHON}/lib/{library.name}"] = os.path.realpath(library)
    for folder in packages().values():
        for path in (folder, f"{folder}.libs"):
            if os.path.isdir(path):
                places[f"{PACKAGES}/{os.path.basename(path)}"] = path
    places |= {f"{COURSE}/{name}": str(PROGRAM.with_name(name)) for name in OURS}
    inside = {name: f"{PACKAGES}/{os.path.basename(folder)}" for name, folder in packages().items()}
    return SandboxMounts(prefix, python, places, tuple(_others(places)), inside)


def _libraries() -> dict[str, str]:
    """Return the folders in which the loader finds shared libraries, under the names it knows."""
    triplet = sysconfig.get_config_var("MULTIARCH") or f"{platform.machine()}-linux-gnu"
    many = [f"{root}/{triplet}" for root in ("/lib", "/usr/lib")]
    few = ["/lib64", "/usr/lib64", *([] if any(map(os.path.isdir, many)) else ["/lib", "/usr/lib"])]
    links = [
        "/etc/ld.so.cache",
        "/etc/alternatives",
    ]  # a system's own numpy finds its BLAS through them
    return {name: os.path.realpath(name) for name in many + few + links if os.path.exists(name)}


def _others(places: dict[str, str]) -> list[str]:
    """Return the folders of packages that lie in what is to be read."""
    found = {
        f"{inside}/{folder.relative_to(outside)}"
        for inside, outside in places.items()
        if os.path.isdir(outside) and not inside.startswith(PACKAGES)
        for pattern in ("*-packages", "python*/*-packages")
        for folder in Path(outside).glob(pattern)
    }
    return sorted(found)
