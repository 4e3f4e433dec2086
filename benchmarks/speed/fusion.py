"""Exposure fusion, beside OpenCV's."""

from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import data, peers
from benchmarks.rows import OURS, Case, Row, Run, close, faster, smaller
from hdrlab.fast import mertens


def case(folder: Path, one_thread: bool) -> Case:
    """Return the work; its error is the difference from OpenCV's picture but for a thousandth of the pixels.

    In these every photograph is gray or flat, none has any weight, and OpenCV lets rounding decide.
    """
    images = data.photographs(folder).images

    def opencv() -> Run:
        cv2 = peers.opencv(one_thread)
        frames = [np.ascontiguousarray(image) for image in images]
        # its own default leaves exposedness out
        return lambda: cv2.createMergeMertens(1, 1, 1).process(frames)

    theirs, missing = peers.present({peers.OPENCV: opencv})

    def error(who: str, fused: Any) -> float | None:
        if who != OURS or not theirs:
            return None
        return float(np.quantile(np.abs(fused - theirs[peers.OPENCV]()).max(axis=-1), 0.999))

    return Case({OURS: lambda: mertens.fuse(images)} | theirs, missing, error, images.nbytes)


ROWS = (
    Row(
        "mertens",
        f"exposure fusion of {data.FRAMES} photographs",
        case,
        (faster(0.8, 1), smaller(0.75), close(0.01, "from OpenCV's picture, 999 of 1000 pixels")),
        "difference from OpenCV's picture",
    ),
)
