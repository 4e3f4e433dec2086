"""Blends from motion blur across an edge (Wilburn, Xu and Matsushita, CVPR 2008, sec. 4 and fig. 7).

row    brightness      (W,), 0 to 1, of one scan line: bright, a dark region, bright
I      irradiance      0, 1, 2 ... from the dark end of a ramp to the bright one: linear if the motion is

While the edge passes, a pixel receives white for a part of the time and black for the rest. If the
edge moves with constant speed, that fraction changes linearly from pixel to pixel. The two edges of
a dark region reveal a motion that is not linear: what makes the left ramp too steep at its dark end
makes the right ramp too steep at its bright end, and their curves differ.
"""

from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.ndimage import median_filter
from scipy.stats import theilslopes

from hdrlab.calibration import joining
from hdrlab.calibration.blends import (
    MAX_BRIGHTNESS,
    MIN_BRIGHTNESS,
    Blend,
    InverseResponse,
    make_blend,
    rmse,
)
from hdrlab.core.arrays import F64, ArrayLike, NDArray, as_stack, levels
from hdrlab.errors import InputError

# fraction of the range; the paper's good example is below, its bad example has 0.028
MAX_RMSE = 0.01


class Ramp(NamedTuple):
    """Pixels start ... stop - 1 of a scan line, on the way from dark to bright or, if it falls, back."""

    row: int
    start: int
    stop: int
    rises: bool


@dataclass(frozen=True)
class Comparison:
    """Whether left and right edges agree, the RMSE between their curves, and the curves."""

    linear: bool
    rmse: float
    left: InverseResponse
    right: InverseResponse


def classify(row: F64, *, low: float, high: float, width: int) -> NDArray[np.int8]:
    """Return -1 where the row is dark, 1 where it is bright, 0 between, by the median of `width` pixels.

    Unlike a mean, it leaves a steep end of a ramp where it is.
    """
    middle = median_filter(row, width, mode="nearest")
    return (middle >= high).astype(np.int8) - (middle <= low).astype(np.int8)


def straighten_edges(found: Sequence[Ramp]) -> list[Ramp]:
    """Return the ramps with ends that lie on straight lines over the rows, as the target's edges do.

    The end of a single ramp depends on its noise, which makes its last samples too dark. A line
    through the ends of all rows (Theil and Sen's, with the median of all slopes) hardly depends on
    the noise of a single row. Ramps far from it belong to something else.
    """
    edges = defaultdict(list)
    ramps_in_row = Counter[int]()
    for ramp in found:
        edges[ramps_in_row[ramp.row], ramp.rises].append(ramp)
        ramps_in_row[ramp.row] += 1
    return sorted(ramp for edge in edges.values() for ramp in _straighten(edge))


def _straighten(edge: Sequence[Ramp]) -> list[Ramp]:
    """Return the ramps of one edge with their ends on two lines, without those off by a tenth of a ramp."""
    row = np.array([ramp.row for ramp in edge])
    start = np.array([ramp.start for ramp in edge])
    stop = np.array([ramp.stop for ramp in edge])
    if len(np.unique(row)) < 3:
        return list(edge)
    first = np.maximum(_fit_line(row, start), 0)
    last = np.maximum(_fit_line(row, stop), 0)
    near = np.maximum(np.abs(first - start), np.abs(last - stop)) <= (last - first) / 10
    return [
        edge[k]._replace(start=int(first[k]), stop=int(last[k]))
        for k in np.flatnonzero(near).tolist()
    ]


def _fit_line(x: NDArray[np.intp], y: NDArray[np.intp]) -> F64:
    """Return the whole numbers nearest to a straight line through y (x), by the slopes of all pairs."""
    # at most 500 samples, as there are many pairs
    every = len(x) // 500 + 1
    line = theilslopes(y[::every], x[::every])
    return np.rint(line.intercept + line.slope * x)


def find_ramps(
    image: ArrayLike,
    *,
    low: float = MIN_BRIGHTNESS,
    high: float = MAX_BRIGHTNESS,
    width: int = 5,
    shortest: int = 8,
) -> list[Ramp]:
    """Return the ramps of each scan line: where it goes from dark to bright, or back.

    Parameters
    ----------
    image : (R, W) uint8 or uint16
        The rows of a photograph to look at, one channel.
    low, high : float
        What is dark and what is bright, 0 to 1: the paper's typical range is 15 to 240 of 255.
    width : int
        Pixels of the median filter, which prevents noise from ending a ramp.
    shortest : int
        Minimum length of a ramp in pixels.

    Raises
    ------
    ValueError
        For an array that is no image, or a range that is empty.

    Examples
    --------
    >>> row = np.r_[np.full(20, 255), np.arange(252, 0, -7), np.zeros(20)].astype(np.uint8)
    >>> find_ramps(np.stack([row, row[::-1]]))
    [Ramp(row=0, start=22, stop=54, rises=False), Ramp(row=1, start=22, stop=54, rises=True)]
    """
    stack = as_stack(np.asarray(image)[None])
    if stack.ndim != 3:
        raise InputError(
            f"expected one channel of a photograph (R, W), got shape {stack.shape[1:]}"
        )
    if not 0 <= low < high <= 1 or width < 1 or shortest < 3:
        raise InputError(f"expected 0 <= {low=} < {high=} <= 1, {width=} >= 1 and {shortest=} >= 3")
    found = []
    for number, row in enumerate(stack[0] / (levels(stack) - 1)):
        side = classify(row, low=low, high=high, width=width)
        ends = np.flatnonzero(side)
        for before, after in zip(ends[:-1], ends[1:], strict=True):
            if side[before] != side[after] and after - before > shortest:
                found.append(Ramp(number, int(before) + 1, int(after), bool(side[after] > 0)))
    return straighten_edges(found)


def read_blends(image: ArrayLike, ramps: Sequence[Ramp]) -> list[Blend]:
    """Return the Blends of ramps in an image (R, W), I = 0, 1, 2 ... from the dark end [sec. 2.2]."""
    stack = as_stack(np.asarray(image)[None])
    blends = []
    for ramp in ramps:
        Z = stack[0, ramp.row, ramp.start : ramp.stop]
        if not ramp.rises:
            Z = Z[::-1]
        M = Z / (levels(stack) - 1)
        blends.append(make_blend(np.arange(len(M)), M, low=0, high=1))
    return blends


def join(
    image: ArrayLike,
    ramps: Sequence[Ramp] | None = None,
    *,
    smoothness: float = 1e-3,
    ends: float = 0.025,
) -> InverseResponse:
    """Return the inverse response that joins all ramps of an image (R, W); see `joining.join`.

    Single pixels are noisier than means over a display's patches, so the spline is stiffer. And the
    ends of a ramp depend on its noise, so about two samples at either end are left out.
    """
    blends = read_blends(image, find_ramps(image) if ramps is None else ramps)
    return joining.join(blends, smoothness=smoothness, ends=ends)


def compare_edges(
    image: ArrayLike, ramps: Sequence[Ramp] | None = None, *, limit: float = MAX_RMSE
) -> Comparison:
    """Return whether the curves of falling and of rising ramps agree: the paper's check of the motion.

    Parameters
    ----------
    image : (R, W) uint8 or uint16
        Scan lines across a dark region on a bright ground, blurred along the lines; one channel.
    ramps : sequence of Ramp, optional
        By default those of `find_ramps`.
    limit : float
        The largest RMSE between the two that passes, 0.01 of the range as in the paper. With 60
        noisy lines, linear motion stays below 0.004 and a speed that grows by 15 % above 0.0105,
        for the response that distinguishes them worst.

    Returns
    -------
    Comparison
        `linear` is True where they agree. Agreement is necessary, not sufficient: an error that is
        symmetric about the middle of the exposure bends both curves alike.

    Raises
    ------
    ValueError
        Where the scan lines do not hold both a falling and a rising ramp.

    References
    ----------
    Wilburn, Xu and Matsushita, CVPR 2008, fig. 7.

    Examples
    --------
    >>> from hdrlab.capture import camera
    >>> dark = np.repeat([1.0, 0.0, 1.0], [110, 60, 110])
    >>> blurred = np.convolve(dark, np.full(40, 1 / 40), "valid")[None].repeat(8, 0)
    >>> image = camera.shoot(blurred, [1.0], camera.Camera(full_well=20_000)).images[0]
    >>> compare_edges(image).linear
    True
    """
    ramps = find_ramps(image) if ramps is None else ramps
    left = [ramp for ramp in ramps if not ramp.rises]
    right = [ramp for ramp in ramps if ramp.rises]
    if not left or not right:
        raise InputError(f"expected ramps on both sides, got {len(left)} down and {len(right)} up")
    left_curve = join(image, left)
    right_curve = join(image, right)
    error = rmse(left_curve, right_curve)
    return Comparison(linear=error <= limit, rmse=error, left=left_curve, right=right_curve)
