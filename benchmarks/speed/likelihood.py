"""The response by maximum likelihood: as accurate as pfshdrcalibrate, and pixel by pixel, as OpenCV does."""

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import data, peers
from benchmarks.rows import OURS, Case, Row, Run, close, faster
from hdrlab.core.arrays import Array
from hdrlab.core.bracket import Bracket
from hdrlab.core.sampling import every_pixel
from hdrlab.fast import robertson
from hdrlab.io.response_files import read_curve, write_curve
from hdrlab.pipeline import recovery

ITERATIONS = 30  # OpenCV's


def accurate(folder: Path, one: bool) -> Case:
    """Return the response as the pipeline asks for it."""
    bracket, saved = data.photographs(folder), folder / "robertson.m"
    theirs, missing = peers.present({peers.PFS: lambda: pfstools(bracket, folder, saved, one)})

    def error(who: str, g: Any) -> float:
        return data.curve_error(read_curve(saved) if who == peers.PFS else g)

    return Case(
        {OURS: lambda: recovery.find_method("robertson")(bracket.images, bracket.times)} | theirs,
        missing,
        error,
        bracket.images.nbytes,
    )


def pfstools(bracket: Bracket, folder: Path, saved: Path, one: bool) -> Run:
    """Return pfshdrcalibrate, less what it takes to merge the same frames by a response that is given."""
    frames, given = peers.pfs_bracket(bracket, folder), folder / "given.m"
    write_curve(given, data.response())
    calibrate, merge = ("-c", "robertson", "-s", str(saved)), ("-c", "robertson", "-f", str(given))
    return peers.pfs_run(["pfshdrcalibrate", *calibrate], frames, one, ("pfshdrcalibrate", *merge))


def all_pixels(folder: Path, one: bool) -> Case:
    """Return the paper's scheme on all pixels, for so many iterations."""
    bracket = data.photographs(folder)
    theirs, missing = peers.present({peers.OPENCV: lambda: opencv(bracket, one)})

    def ours() -> Array:
        steps = partial(robertson.recover_steps, max_iterations=ITERATIONS, tolerance=0)
        return robertson.recover(bracket.images, bracket.times, choose=every_pixel, steps=steps)

    def error(who: str, found: Any) -> float:
        return data.curve_error(np.log(np.maximum(found, 1e-30)) if who == peers.OPENCV else found)

    return Case({OURS: ours} | theirs, missing, error, bracket.images.nbytes)


def opencv(bracket: Bracket, one: bool) -> Run:
    """Return CalibrateRobertson; with a threshold of 0 it takes all its iterations."""
    cv2 = peers.opencv(one)
    frames, times = list(bracket.images), bracket.times.astype(np.float32)
    return lambda: cv2.createCalibrateRobertson(ITERATIONS, 0).process(frames, times)


ROWS = (
    Row(
        "robertson",
        f"response by maximum likelihood from {data.FRAMES} photographs, three channels",
        accurate,
        (faster(15, 30), close(0.5, "% error of the curve")),
        "error of the curve, % of its top",
    ),
    Row(
        "robertson-all",
        f"the same from all pixels, {ITERATIONS} iterations",
        all_pixels,
        (faster(2, 6),),
        "error of the curve, % of its top",
    ),
)
