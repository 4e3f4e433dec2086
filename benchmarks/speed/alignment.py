"""Median threshold bitmaps: seven photographs of a shaking hand, aligned, moved and cut."""

from pathlib import Path

import numpy as np

from benchmarks import data, peers
from benchmarks.rows import OURS, Case, Row, Run, close, faster
from hdrlab.align.shift import shift
from hdrlab.core.arrays import Array
from hdrlab.pipeline.alignment import register

RADIUS = 8


def case(folder: Path, one_thread: bool) -> Case:
    """Return the work: everyone answers with the moved photographs, and is then asked for the offsets."""
    images = data.photographs(folder, radius=RADIUS).images

    def ours() -> Array:
        return shift(images, offsets(images))

    theirs, missing = peers.present({peers.OPENCV: lambda: opencv(images, one_thread)})

    def lost(who: str, result: Array) -> float:
        answer = offsets(images) if who == OURS else opencv_offsets(images, one_thread)
        return float(np.sum(np.abs(answer - data.moves(RADIUS)).max(axis=1) > 1))

    return Case({OURS: ours} | theirs, missing, lost, images.nbytes)


def offsets(images: Array) -> Array:
    """Return what the pipeline finds for each photograph, (dy, dx)."""
    return register(images, "mtb").homographies[:, 1::-1, 2].astype(int)


def opencv(images: Array, one_thread: bool) -> Run:
    """Return AlignMTB, which moves and cuts as well."""
    cv2 = peers.opencv(one_thread)
    frames = [np.ascontiguousarray(image[..., ::-1]) for image in images]
    return lambda: cv2.createAlignMTB().process(frames, [np.empty_like(frame) for frame in frames])


def opencv_offsets(images: Array, one_thread: bool) -> Array:
    """Return what AlignMTB finds for each photograph against the middle one, (dy, dx)."""
    aligner = peers.opencv(one_thread).createAlignMTB()
    gray = [np.ascontiguousarray(image[..., 1]) for image in images]
    return np.array([aligner.calculateShift(gray[len(gray) // 2], frame)[::-1] for frame in gray])


ROWS = (
    Row(
        "mtb",
        f"alignment of {data.FRAMES} photographs, up to {RADIUS} pixels apart",
        case,
        (faster(1.8, 3), close(0, "photographs more than 1 pixel off")),
        "photographs more than 1 pixel off",
    ),
)
