"""Who registers a pair: hdrlab in four ways, and its peers. Each tells a move, and whether it warnings it.

images  (2, H, W, 3) uint8: the darker photograph, which moves, and the brighter
times   (2,) s
answer  (3, 3), where pixel (x, y, 1) of the first lies on the second, and whether it is doubted
"""

import shutil
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path

import imageio.v3 as iio
import numpy as np
from skimage.registration import phase_cross_correlation

from benchmarks import peers
from hdrlab.capture.responses import true_g
from hdrlab.core.arrays import Array, ArrayLike, NDArray
from hdrlab.core.filters import warp
from hdrlab.pipeline.alignment import register

Float = NDArray[np.float64]
Answer = tuple[Float, bool]
Way = Callable[[Array, Float], Answer]
HUGIN = "align_image_stack"
# Hugin explains a shift by a lens that turns, which also changes the perspective. With its default,
# a field of view of 50 degrees, a shift by 10 pixels puts the corners off by 2 pixels. With a long
# lens a turn is a shift, as in the brackets of this benchmark, whose truth is a shift and a
# rotation about the middle.
HUGIN_FIELD_OF_VIEW_DEGREES = 5
# Points are searched for at full size; by default, at half the size.
HUGIN_OPTIONS = ("--use-given-order", "-f", str(HUGIN_FIELD_OF_VIEW_DEGREES), "-s", "0")


def shifted(offset: ArrayLike) -> Float:
    """Return the move of an offset (dy, dx)."""
    return np.asarray(warp.as_homographies(np.asarray(offset, float)[None])[0])


def by_mtb(images: Array, _: Float) -> Answer:
    """Answer by bitmaps."""
    (pair,) = register(images, "mtb").pairs
    return pair.H, not pair.reliable


def by_light(images: Array, times: Float) -> Answer:
    """Answer by correlation and simplex, the response known."""
    (pair,) = register(images, "cerman", times=times, g=true_g("film")).pairs
    return pair.H, not pair.reliable


def by_histograms(images: Array, _: Float) -> Answer:
    """Answer by correlation and simplex, neither response nor times known."""
    (pair,) = register(images, "cerman").pairs
    return pair.H, not pair.reliable


def by_points(images: Array, _: Float) -> Answer:
    """Answer by a homography, neither response nor times known."""
    (pair,) = register(images, "homography").pairs
    return pair.H, not pair.reliable


def by_opencv(images: Array, _: Float) -> Answer:
    """Answer by OpenCV's bitmaps, of the green channel."""
    cv2 = peers.opencv(True)
    dx, dy = cv2.createAlignMTB().calculateShift(images[1, ..., 1].copy(), images[0, ..., 1].copy())
    return shifted((dy, dx)), False


def by_phase(images: Array, _: Float) -> Answer:
    """Answer by scikit-image's phase correlation to a tenth of a pixel, of the green channel."""
    dark, bright = images[..., 1].astype(float)
    offset, *_ = phase_cross_correlation(bright, dark, upsample_factor=10)
    return shifted(offset), False


def by_hugin(images: Array, _: Float) -> Answer:
    """Answer by Hugin's align_image_stack: points, and a camera that turns about its lens."""
    if missing := [program for program in (HUGIN, "pano_trafo") if shutil.which(program) is None]:
        raise peers.Missing(f"no {missing[0]} on the path (apt install hugin-tools)")
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        project = folder / "stack.pto"
        files = [folder / "bright.tif", folder / "dark.tif"]
        for path, image in zip(files, images[::-1], strict=True):
            iio.imwrite(path, image)
        command = [HUGIN, *HUGIN_OPTIONS, "-p", str(project), *map(str, files)]
        if (
            subprocess.run(command, cwd=folder, capture_output=True).returncode
            or not project.exists()
        ):
            return np.eye(3), True  # it says that it found no points
        seen = _traced([str(project), "1"], warp.corners(images.shape[1:3]))
        return warp.through(
            warp.corners(images.shape[1:3]), _traced(["-r", str(project), "0"], seen)
        ), False


def _traced(options: list[str], points: Float) -> Float:
    """Return where Hugin puts points (n, 2), (x, y)."""
    text = "".join(f"{x} {y}\n" for x, y in points)
    done = subprocess.run(
        ["pano_trafo", *options], input=text, capture_output=True, text=True, check=True
    )
    return np.array([line.split()[:2] for line in done.stdout.splitlines() if line.strip()], float)


HDRLAB: dict[str, Way] = {
    "mtb": by_mtb,
    "cerman, response known": by_light,
    "cerman, by histograms": by_histograms,
    "homography, by histograms": by_points,
}
PEERS: dict[str, Way] = {
    "OpenCV AlignMTB": by_opencv,
    HUGIN: by_hugin,
    "scikit-image, phase": by_phase,
}
