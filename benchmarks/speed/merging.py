"""The radiance map of seven photographs, given the camera's own response."""

from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import data, peers
from benchmarks.measure import process
from benchmarks.rows import OURS, Case, Row, Run, Usage, close, faster, smaller
from hdrlab.core.arrays import Array
from hdrlab.core.bracket import Bracket
from hdrlab.core.weights import gaussian
from hdrlab.radiance.merge import merge


def case(folder: Path, one: bool) -> Case:
    """Return the work."""
    bracket, truth, g = data.photographs(folder), data.scene(folder), data.response()
    threads = 1 if one else None

    def ours() -> Array:
        return merge(bracket.images, bracket.times, g, threads=threads)

    theirs, missing = peers.present(
        {
            peers.OPENCV: lambda: opencv(bracket, g, one),
            peers.COLOUR: lambda: colour_hdri(bracket, g),
            peers.PFS: lambda: pfstools(bracket, g, folder, one),
        }
    )

    def error(who: str, E: Any) -> float | None:
        if isinstance(E, Usage):
            return None
        return data.log_error(E[..., ::-1] if who == peers.OPENCV else E, truth, bracket.images)

    return Case({OURS: ours} | theirs, missing, error)


def opencv(bracket: Bracket, g: Array, one: bool) -> Run:
    """Return MergeDebevec."""
    cv2 = peers.opencv(one)
    frames = [np.ascontiguousarray(image[..., ::-1]) for image in bracket.images]
    times, response = bracket.times.astype(np.float32), np.exp(g[:, None]).astype(np.float32)
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


def pfstools(bracket: Bracket, g: Array, folder: Path, one: bool) -> Run:
    """Return pfshdrcalibrate, the response given, less what it takes to read the frames and do nothing."""
    calibrate, idle, reader = map(peers.pfstools, ("pfshdrcalibrate", "pfstag", "pfsinhdrgen"))
    response, frames = folder / "response.m", folder / "photographs.pfs"
    listed = folder / "photographs.hdrgen"
    response.write_text(pfs_response(g), encoding="ascii")
    lines = []
    for j, (image, time) in enumerate(zip(bracket.images, bracket.times, strict=True)):
        path = folder / f"photograph-{j}.ppm"
        path.write_bytes(b"P6\n%d %d\n255\n" % image.shape[1::-1] + image.tobytes())
        lines.append(f"{path} {1 / time:.9g} 1 100 0\n")
    listed.write_text("".join(lines), encoding="utf8")
    process([reader, str(listed)], one=one, target=frames)

    def run() -> Usage:
        busy = process([calibrate, "-f", str(response)], one=one, source=frames)
        return busy.net(process([idle], one=one, source=frames))

    return run


def pfs_response(g: Array) -> str:
    """Return the response and its weights in the matrices that pfshdrcalibrate reads."""
    text = ""
    for name, curve in zip(("IR", "IG", "IB"), g.T, strict=True):
        rows = [f"{value / np.log(10):e} {z} {np.exp(value):e}" for z, value in enumerate(curve)]
        text += _matrix(name, rows)
    return text + _matrix("W", [f"{value:e} {z}" for z, value in enumerate(gaussian())])


def _matrix(name: str, rows: list[str]) -> str:
    size = f"# rows: {len(rows)}\n# columns: {len(rows[0].split())}\n"
    head = f"# {name}\n# layout\n# name: {name}\n# type: matrix\n{size}"
    return head + "\n".join(rows) + "\n\n"


ROWS = (
    Row(
        "merge",
        f"radiance map of {data.FRAMES} photographs",
        case,
        (faster(6, 10), smaller(0.25), close(0.010, "RMS of log10 E / truth")),
        "RMS of log10 E / truth",
    ),
)
