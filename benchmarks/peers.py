"""The peers: imported where they are used, with the reason where one is missing."""

import importlib
import shutil
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, version
from types import ModuleType

from benchmarks.rows import Run

OPENCV, COLOUR, PFS, OPENEXR = "OpenCV", "colour-hdri", "pfstools", "OpenEXR"
PACKAGES = {OPENCV: "opencv-python-headless", COLOUR: "colour-hdri", OPENEXR: "OpenEXR"}


class Missing(Exception):
    """A peer that is not installed; its text says what to install."""


def opencv(one: bool) -> ModuleType:
    """Return cv2, held to one thread or not."""
    cv2 = _module("cv2", OPENCV)
    if one:
        cv2.setNumThreads(1)
    return cv2


def colour_hdri() -> ModuleType:
    """Return colour_hdri."""
    return _module("colour_hdri", COLOUR)


def openexr() -> ModuleType:
    """Return OpenEXR."""
    return _module("OpenEXR", OPENEXR)


def pfstools(program: str) -> str:
    """Return the path of one of the pfstools."""
    found = shutil.which(program)
    if found is None:
        raise Missing(f"no {program} on the path (apt install pfstools)")
    return found


def present(makers: dict[str, Callable[[], Run]]) -> tuple[dict[str, Run], dict[str, str]]:
    """Return the runs of the peers that are there, and why the others are missing."""
    runs, missing = {}, {}
    for peer, make in makers.items():
        try:
            runs[peer] = make()
        except Missing as reason:
            missing[peer] = str(reason)
    return runs, missing


def versions() -> str:
    """Return the versions of the peers that are Python packages, for the head of a report."""
    said = []
    for peer, package in PACKAGES.items():
        try:
            said.append(f"{peer} {version(package)}")
        except PackageNotFoundError:
            said.append(f"no {peer}")
    return ", ".join(said)


def _module(name: str, peer: str) -> ModuleType:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise Missing(f"{error} (pip install {PACKAGES[peer]})") from None
