"""The whole command: seven JPEGs of 12 megapixels to a map and a picture, beside a script of OpenCV."""

import sys
from pathlib import Path

import numpy as np
from PIL import Image

from benchmarks import data, peers
from benchmarks.measure import ROOT, process
from benchmarks.rows import OURS, Case, Row, Run, Usage, close, faster, smaller
from hdrlab.capture.hand_motion import views
from hdrlab.core.types import Array
from hdrlab.io.maps import rgbe

RADIUS = 16


def case(folder: Path, one: bool) -> Case:
    """Return the work; the files that were written tell how far they are from the truth."""
    photographs = folder / "jpeg"
    write_photographs(photographs, folder)

    def run(command: list[str], who: str) -> Usage:
        files = [str(folder / f"{who}.hdr"), "--picture", str(folder / f"{who}.png")]
        return process([sys.executable, *command, *files], one=one)

    times = folder / "times.csv"
    ours = ["-m", "hdrlab", "assemble", str(photographs), "--times", str(times), "-o"]
    script = [str(ROOT / "benchmarks" / "opencv_assemble.py"), str(photographs), str(times)]

    def opencv() -> Run:
        peers.opencv(one)
        return lambda: run(script, peers.OPENCV)

    theirs, missing = peers.present({peers.OPENCV: opencv})
    frames = data.photographs(folder, data.LARGE, radius=RADIUS).images.nbytes  # decoded
    return Case({OURS: lambda: run(ours, OURS)} | theirs, missing, lambda who, _: error(folder, who), frames)


def write_photographs(photographs: Path, folder: Path) -> None:
    """Write the photographs as JPEGs of quality 95, and the list of their times."""
    photographs.mkdir(exist_ok=True)
    bracket = data.photographs(folder, data.LARGE, radius=RADIUS)
    lines = ["file,exposure_time_s"]
    for j, (image, time) in enumerate(zip(bracket.images, bracket.times, strict=True)):
        path = photographs / f"{j}.jpg"
        lines.append(f"{path.name},{time:.9g}")
        if not path.exists():
            Image.fromarray(image).save(path, quality=95)
    (folder / "times.csv").write_text("\n".join(lines) + "\n", encoding="utf8")


def error(folder: Path, who: str) -> float:
    """Return the error of a map on the rectangle that all photographs show, placed as in the middle one."""
    E, moves = rgbe.read(folder / f"{who}.hdr"), data.moves(RADIUS)
    top, left = moves.max(axis=0)
    bottom, right = -moves.min(axis=0)
    shown = (slice(top, -bottom or None), slice(left, -right or None))
    truth = views(data.scene(folder, data.LARGE), moves)[data.FRAMES // 2][shown]
    images = data.photographs(folder, data.LARGE, radius=RADIUS).images
    if E.shape != truth.shape:
        E = E[shown]
    if E.shape != truth.shape:
        return float("inf")
    return data.log_error(np.maximum(E, 1e-9), truth, _moved(images, moves, shown))


def _moved(images: Array, moves: Array, shown: tuple[slice, slice]) -> Array:
    """Return the photographs on that rectangle; what wraps around lies outside it."""
    return np.stack(
        [np.roll(image, tuple(move), (0, 1))[shown] for image, move in zip(images, moves, strict=True)]
    )


ROWS = (
    Row(
        "assemble",
        f"`hdrlab assemble` of {data.FRAMES} JPEGs of 12 megapixels, whole command",
        case,
        (faster(1.2, 2), smaller(0.5), close(0.05, "RMS of log10 E / truth")),
        "RMS of log10 E / truth",
    ),
)
