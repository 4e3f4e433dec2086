"""The radiance map of seven photographs, given the camera's own response."""

from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import data, peers
from benchmarks.rows import OURS, Case, Hold, Results, Row, Run, Usage, close, faster, smaller
from hdrlab.core.arrays import Array
from hdrlab.core.bracket import Bracket
from hdrlab.fast import merge
from hdrlab.io.response_files import write_curve
from hdrlab.radiance import uncertainty
from hdrlab.radiance.merge import merge_with_quality


def case(folder: Path, one_thread: bool) -> Case:
    """Return the work."""
    bracket = data.photographs(folder)
    truth = data.scene(folder)
    g = data.response()

    def ours() -> Array:
        return merge.merge_with_quality(bracket.images, bracket.times, g).E

    theirs, missing = peers.present(
        {
            peers.OPENCV: lambda: opencv(bracket, g, one_thread),
            peers.COLOUR: lambda: colour_hdri(bracket, g),
            peers.PFS: lambda: pfstools(bracket, g, folder, one_thread),
        }
    )

    def error(who: str, E: Any) -> float | None:
        if isinstance(E, Usage):
            return None
        return data.log_error(E[..., ::-1] if who == peers.OPENCV else E, truth, bracket.images)

    return Case({OURS: ours} | theirs, missing, error, bracket.images.nbytes)


def opencv(bracket: Bracket, g: Array, one_thread: bool) -> Run:
    """Return MergeDebevec."""
    cv2 = peers.opencv(one_thread)
    frames = [np.ascontiguousarray(image[..., ::-1]) for image in bracket.images]
    times = bracket.times.astype(np.float32)
    response = np.exp(g[:, None]).astype(np.float32)
    return lambda: cv2.createMergeDebevec().process(frames, times, response)


def colour_hdri(bracket: Bracket, g: Array) -> Run:
    """Return image_stack_to_HDRI, of photographs as it wants them: positive floats up to 1."""
    package = peers.colour_hdri()
    frames = [np.maximum(image, 1) / 255 for image in bracket.images]
    curves = np.exp(g - g[-1])

    def run() -> Array:
        stack = package.ImageStack()
        for frame, time in zip(frames, bracket.times, strict=True):
            stack.append(package.Image(data=frame, metadata=package.Metadata(1, time, 100)))
        return np.asarray(package.image_stack_to_HDRI(stack, camera_response_functions=curves))

    return run


def pfstools(bracket: Bracket, g: Array, folder: Path, one_thread: bool) -> Run:
    """Return pfshdrcalibrate, the response given."""
    frames = peers.pfs_bracket(bracket, folder)
    response = folder / "response.m"
    write_curve(response, g)
    return peers.pfs_run(["pfshdrcalibrate", "-f", str(response)], frames, one_thread)


PLAIN = "the plain merge"
# electrons of a pixel at level n / 2, and of the amplifier
ELECTRONS = {"N": 10_000.0, "R": 5.0}


def deviation_case(folder: Path, one_thread: bool) -> Case:
    """Return the work of the mean by inverse variance with its standard deviation, beside the plain mean."""
    bracket = data.photographs(folder)
    truth = data.scene(folder)
    g = data.response()

    def ours() -> Array:
        return uncertainty.merge_with_deviation(bracket.images, bracket.times, g, **ELECTRONS).E

    def plain() -> Array:
        return merge_with_quality(bracket.images, bracket.times, g).E

    def error(who: str, E: Any) -> float | None:
        return data.log_error(E, truth, bracket.images)

    return Case({OURS: ours, PLAIN: plain}, {}, error, bracket.images.nbytes)


def slower(results: Results) -> float:
    """Return how many times as long as the plain merge the deviation takes."""
    return results[OURS].seconds / results[PLAIN].seconds


ROWS = (
    Row(
        "merge",
        f"radiance map of {data.FRAMES} photographs",
        case,
        (faster(6, 10), smaller(0.25), close(0.010, "RMS of log10 E / truth")),
        "RMS of log10 E / truth",
    ),
    Row(
        "deviation",
        f"radiance map of {data.FRAMES} photographs with its standard deviation, both in the lesson's form",
        deviation_case,
        (Hold(f"times as long as {PLAIN}", slower, 1.6), close(0.010, "RMS of log10 E / truth")),
        "RMS of log10 E / truth",
    ),
)
