"""The peers: imported where they are used, with the reason where one is missing."""

import importlib
import shutil
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from types import ModuleType

from benchmarks.measure import process
from benchmarks.rows import Run, Usage
from hdrlab.core.bracket import Bracket

OPENCV = "OpenCV"
COLOUR = "colour-hdri"
PFS = "pfstools"
OPENEXR = "OpenEXR"
HALIDE = "Halide"
PACKAGES = {OPENCV: "opencv-contrib-python-headless", COLOUR: "colour-hdri", OPENEXR: "OpenEXR"}
PACKAGES |= {HALIDE: "halide"}


class Missing(Exception):
    """A peer that is not installed; its text says what to install."""


def opencv(one_thread: bool) -> ModuleType:
    """Return cv2, held to one thread or not."""
    cv2 = _module("cv2", OPENCV)
    if one_thread:
        cv2.setNumThreads(1)
    return cv2


def colour_hdri() -> ModuleType:
    """Return colour_hdri."""
    return _module("colour_hdri", COLOUR)


def colour_science() -> ModuleType:
    """Return colour.models of colour-science, which colour-hdri brings."""
    return _module("colour.models", COLOUR)


def openexr() -> ModuleType:
    """Return OpenEXR."""
    return _module("OpenEXR", OPENEXR)


def halide() -> ModuleType:
    """Return halide."""
    return _module("halide", HALIDE)


def pfstools(name: str) -> str:
    """Return the path of one of the pfstools."""
    return program(name, "apt install pfstools")


def program(name: str, installation: str) -> str:
    """Return the path of a program; where it is missing, say how to install it."""
    path = shutil.which(name)
    if path is None:
        raise Missing(f"no {name} on the path ({installation})")
    return path


def pfs_bracket(bracket: Bracket, folder: Path) -> Path:
    """Return a file with the frames of a bracket as pfstools read them."""
    frames = folder / "photographs.pfs"
    listed = folder / "photographs.hdrgen"
    lines = []
    for j, (image, time) in enumerate(zip(bracket.images, bracket.times, strict=True)):
        path = folder / f"photograph-{j}.ppm"
        path.write_bytes(b"P6\n%d %d\n255\n" % image.shape[1::-1] + image.tobytes())
        lines.append(f"{path} {1 / time:.9g} 1 100 0\n")
    listed.write_text("".join(lines), encoding="utf8")
    process([pfstools("pfsinhdrgen"), str(listed)], one_thread=False, target=frames)
    return frames


def pfs_run(
    command: list[str], source: Path, one_thread: bool, idle: tuple[str, ...] = ("pfstag",)
) -> Run:
    """Return a run of one of the pfstools, less what the idle one takes: to read and write the same alone."""
    busy = [pfstools(command[0]), *command[1:]]
    rest = [pfstools(idle[0]), *idle[1:]]

    def run() -> Usage:
        spent = process(busy, one_thread=one_thread, source=source)
        return spent.net(process(rest, one_thread=one_thread, source=source))

    return run


def present(makers: dict[str, Callable[[], Run]]) -> tuple[dict[str, Run], dict[str, str]]:
    """Return the runs of the peers that are there, and why the others are missing."""
    runs = {}
    missing = {}
    for peer, make in makers.items():
        try:
            runs[peer] = make()
        except Missing as reason:
            missing[peer] = str(reason)
    return runs, missing


def versions() -> str:
    """Return the versions of the peers that are Python packages, for the head of a report."""
    lines = []
    for peer, package in PACKAGES.items():
        try:
            lines.append(f"{peer} {version(package)}")
        except PackageNotFoundError:
            lines.append(f"no {peer}")
    return ", ".join(lines)


def _module(name: str, peer: str) -> ModuleType:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise Missing(f"{error} (pip install {PACKAGES[peer]})") from None
