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


def accurate(folder: Path, one_thread: bool) -> Case:
    """Return the response as the pipeline asks for it."""
    bracket = data.photographs(folder)
    saved = folder / "robertson.m"
    theirs, missing = peers.present(
        {peers.PFS: lambda: pfstools(bracket, folder, saved, one_thread)}
    )

    def error(who: str, g: Any) -> float:
        return data.curve_error(read_curve(saved) if who == peers.PFS else g)

    return Case(
        {OURS: lambda: recovery.find_method("robertson")(bracket.images, bracket.times)} | theirs,
        missing,
        error,
        bracket.images.nbytes,
    )


def pfstools(bracket: Bracket, folder: Path, saved: Path, one_thread: bool) -> Run:
    """Return pfshdrcalibrate, less what it takes to merge the same frames by a response that is given."""
    frames = peers.pfs_bracket(bracket, folder)
    response_file = folder / "given.m"
    write_curve(response_file, data.response())
    calibrate = ("-c", "robertson", "-s", str(saved))
    merge = ("-c", "robertson", "-f", str(response_file))
    return peers.pfs_run(
        ["pfshdrcalibrate", *calibrate], frames, one_thread, ("pfshdrcalibrate", *merge)
    )


def all_pixels(folder: Path, one_thread: bool) -> Case:
    """Return the paper's scheme on all pixels, for so many iterations."""
    bracket = data.photographs(folder)
    theirs, missing = peers.present({peers.OPENCV: lambda: opencv(bracket, one_thread)})

    def ours() -> Array:
        steps = partial(robertson.recover_steps, max_iterations=ITERATIONS, tolerance=0)
        return robertson.recover(bracket.images, bracket.times, choose=every_pixel, steps=steps)

    def error(who: str, curve: Any) -> float:
        return data.curve_error(np.log(np.maximum(curve, 1e-30)) if who == peers.OPENCV else curve)

    return Case({OURS: ours} | theirs, missing, error, bracket.images.nbytes)


def opencv(bracket: Bracket, one_thread: bool) -> Run:
    """Return CalibrateRobertson; with a threshold of 0 it takes all its iterations."""
    cv2 = peers.opencv(one_thread)
    frames = list(bracket.images)
    times = bracket.times.astype(np.float32)
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
