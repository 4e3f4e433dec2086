"""Luminance HDR as a peer: its operators from the command line, without a screen, in a home of its own."""

import shutil
from pathlib import Path

from benchmarks import peers
from benchmarks.measure import process
from benchmarks.rows import Run, Usage
from hdrlab.core.arrays import Array
from hdrlab.io.maps import rgbe

NAME = "Luminance HDR"
SIMPLEST = "drago"  # one curve for all pixels
FLOATS = ("--ldrTiff", "32b", "--ldrTiffDeflate", "false")


def operator(E: Array, folder: Path, one_thread: bool, name: str, *options: str) -> Run:
    """Return one of its operators, less what the simplest of them takes with the same files.

    That takes off reading, colours and writing, and a little too much: the work of the simplest.
    """
    program = shutil.which("luminance-hdr-cli")
    if program is None:
        raise peers.Missing("no luminance-hdr-cli on the path (apt install luminance-hdr)")
    scene = folder / "scene.hdr"
    home = folder / "home"
    rgbe.write(scene, E)
    home.mkdir(exist_ok=True)
    start = ["env", f"HOME={home}", "QT_QPA_PLATFORM=offscreen", program, "--load", str(scene)]

    def spent(name: str, *options: str) -> Usage:
        picture = folder / f"{name}.tif"
        return process(
            [*start, "--tmo", name, *options, "--output", str(picture), *FLOATS],
            one_thread=one_thread,
        )

    return lambda: spent(name, *options).net(spent(SIMPLEST))
