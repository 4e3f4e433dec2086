"""The whole command: seven JPEGs of 12 megapixels to a map and a picture, beside a script of OpenCV.

Larger ones are made of these: beside and below each photograph stands the same once more, which the
hand moved as well, and not its mirror image, which would have moved the other way.
"""

import sys
from functools import partial
from pathlib import Path

import numpy as np
from PIL import Image

from benchmarks import data, peers
from benchmarks.measure import ROOT, process
from benchmarks.rows import (
    OURS,
    Case,
    Hold,
    Results,
    Row,
    Run,
    Usage,
    close,
    faster_by_default,
    grows,
    smaller,
)
from hdrlab.capture.hand_motion import views
from hdrlab.core.arrays import Array
from hdrlab.io.maps import rgbe

RADIUS = 16
SIZES = {"12 MP": (1, 1), "24 MP": (1, 2), "48 MP": (2, 2)}


def case(folder: Path, one_thread: bool) -> Case:
    """Return the work; the files that were written tell how far they are from the truth."""
    photographs = folder / "jpeg"
    write_photographs(photographs, folder)

    def run(command: list[str], who: str) -> Usage:
        files = [str(folder / f"{who}.hdr"), "--picture", str(folder / f"{who}.png")]
        return process([sys.executable, *command, *files], one_thread=one_thread)

    times = folder / "times.csv"
    ours = ["-m", "hdrlab", "assemble", str(photographs), "--times", str(times), "-o"]
    script = [str(ROOT / "benchmarks" / "opencv_assemble.py"), str(photographs), str(times)]

    def opencv() -> Run:
        peers.opencv(one_thread)
        return lambda: run(script, peers.OPENCV)

    theirs, missing = peers.present({peers.OPENCV: opencv})
    frames = data.photographs(folder, data.LARGE, radius=RADIUS).images.nbytes  # decoded
    return Case(
        {OURS: lambda: run(ours, OURS)} | theirs, missing, lambda who, _: error(folder, who), frames
    )


def growing(folder: Path, one_thread: bool) -> Case:
    """Return the work at every size of SIZES, by the command alone."""
    write_photographs(folder / "jpeg", folder)
    runs: dict[str, Run] = {}
    reads: dict[str, int] = {}
    for size, (down, across) in SIZES.items():
        photographs = enlarge(folder / "jpeg", folder / f"jpeg-{down}-{across}", down, across)
        files = ["-o", str(folder / "large.hdr"), "--picture", str(folder / "large.png")]
        command = [
            "-m",
            "hdrlab",
            "assemble",
            str(photographs),
            "--times",
            str(folder / "times.csv"),
            *files,
        ]
        runs[size] = partial(process, [sys.executable, *command], one_thread=one_thread)
        reads[size] = 3 * data.FRAMES * data.LARGE[0] * data.LARGE[1] * down * across
    return Case(runs, {}, reads=reads)


def enlarge(photographs: Path, folder: Path, down: int, across: int) -> Path:
    """Return a folder with the photographs, each `down` and `across` times."""
    if (down, across) == (1, 1):
        return photographs
    folder.mkdir(exist_ok=True)
    for path in sorted(photographs.iterdir()):
        if not (folder / path.name).exists():
            image = np.tile(np.asarray(Image.open(path)), (down, across, 1))
            Image.fromarray(image).save(folder / path.name, quality=95)
    return folder


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
    E = rgbe.read(folder / f"{who}.hdr")
    moves = data.moves(RADIUS)
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
        [
            np.roll(image, tuple(move), (0, 1))[shown]
            for image, move in zip(images, moves, strict=True)
        ]
    )


def memory_growth(results: Results) -> float | None:
    """Return the peak memory of 48 MP over four times that of 12 MP."""
    large = results["48 MP"].megabytes
    small = results["12 MP"].megabytes
    return large / (4 * small) if large and small else None


ROWS = (
    Row(
        "assemble",
        f"`hdrlab assemble` of {data.FRAMES} JPEGs of 12 megapixels, whole command",
        case,
        (faster_by_default(3, 4), smaller(0.4), close(0.05, "RMS of log10 E / truth")),
        "RMS of log10 E / truth",
    ),
    Row(
        "assemble-48",
        f"`hdrlab assemble` of {data.FRAMES} JPEGs of 12, 24 and 48 megapixels, whole command",
        growing,
        (
            grows("12 MP", "24 MP", 2, 1.15),
            grows("12 MP", "48 MP", 4, 1.15),
            Hold("MB in all, 48 MP", lambda results: results["48 MP"].megabytes, 2500),
            Hold("of four times the memory of 12 MP", memory_growth, 1),
        ),
    ),
)
