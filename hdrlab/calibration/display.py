"""Mixtures of two lights on a display (Wilburn, Xu and Matsushita, CVPR 2008, sec. 3 and 6).

P_hi, P_lo  pixel values          the two that a patch shows, 0 to 255
T           steps                 pictures in a sequence: 15, of four frames each, at 60 Hz in one second
k           number of a patch     1 ... rows columns, row by row in its grid
alpha       share of P_hi         (rows, columns): k / T

Patch k shows P_hi in the first k pictures and P_lo in the others: it switches once a sequence, so
what a display does while it switches is the same for every patch, and little of it. A sequence may
be repeated without a pause: an exposure as long as the sequence then holds all of it, wherever it
begins.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from hdrlab.calibration import blends, chart
from hdrlab.core.arrays import F64, ArrayLike, NDArray
from hdrlab.errors import InputError


class Schedule(NamedTuple):
    """What the display shows: one grid of rows x columns patches for each pixel value of `high`.

    `high` holds the P_hi, of which the brightest should just saturate the camera, `low` is P_lo;
    `steps` is T; `patch` and `border` are widths in display pixels, and the border is black.
    """

    high: Sequence[int] = (220, 100)
    low: int = 0
    rows: int = 3
    columns: int = 5
    steps: int = 15
    patch: int = 30
    border: int = 30


DEFAULT = Schedule()


def mixing_ratios(rows: int = 3, columns: int = 5, steps: int = 15) -> F64:
    """Return alpha = k / T (rows, columns) [Wilburn08 eq. 4].

    Raises
    ------
    ValueError
        For more patches than steps, of which some would look alike.

    Examples
    --------
    >>> mixing_ratios(2, 2, 4)
    array([[0.25, 0.5 ],
           [0.75, 1.  ]])
    """
    if rows < 1 or columns < 1 or steps < rows * columns:
        raise InputError(
            f"expected at least as many steps as patches, got {rows} x {columns} and {steps}"
        )
    return np.arange(1, rows * columns + 1).reshape(rows, columns) / steps


def draw_patches(
    values: NDArray[np.uint8], *, patch: int, border: int, shape: tuple[int, int]
) -> NDArray[np.uint8]:
    """Return a picture of `shape` with the patches in its middle, `patch` wide, `border` of black between.

    Without the black, the light of bright neighbours would spill into a patch [Wilburn08 sec. 3].
    """
    cell = np.pad(np.ones((patch, patch), np.uint8), (0, border))
    grid = np.kron(values, cell)[: -border or None, : -border or None]
    before = [(whole - part) // 2 for whole, part in zip(shape, grid.shape, strict=True)]
    after = [
        whole - part - first for whole, part, first in zip(shape, grid.shape, before, strict=True)
    ]
    return np.pad(grid, list(zip(before, after, strict=True)))


def draw_schedule(
    schedule: Schedule = DEFAULT, *, shape: tuple[int, int] = (480, 640)
) -> NDArray[np.uint8]:
    """Return the pictures (T, H, W) of a sequence, each of `shape`; the grids lie one under the other.

    Raises
    ------
    ValueError
        For values that are no pixel values, P_hi not above P_lo, or grids that do not fit.

    Examples
    --------
    >>> two = Schedule((255,), rows=1, columns=2, steps=2, patch=1, border=1)
    >>> draw_schedule(two, shape=(1, 3)).tolist()
    [[[255, 0, 255]], [[0, 0, 255]]]
    """
    high = schedule.high
    low = schedule.low
    patch = schedule.patch
    border = schedule.border
    steps = schedule.steps
    if not high or not all(0 <= low < P_hi <= 255 for P_hi in high):
        raise InputError(
            f"expected pixel values 0 <= low < high <= 255, got {low} and {list(high)}"
        )
    if patch < 1 or border < 0:
        raise InputError(f"expected patch >= 1 and border >= 0 pixels, got {patch} and {border}")
    alpha = mixing_ratios(schedule.rows, schedule.columns, steps)
    last_step = np.tile(np.round(alpha * steps), (len(high), 1))
    grid_rows, grid_columns = last_step.shape
    height = grid_rows * (patch + border) - border
    width = grid_columns * (patch + border) - border
    if height > shape[0] or width > shape[1]:
        raise InputError(f"expected pictures of at least {height} x {width} pixels, got {shape}")
    P_hi = np.repeat(high, schedule.rows)[:, None]
    pictures = []
    for step in range(steps):
        values = np.where(step < last_step, P_hi, low).astype(np.uint8)
        pictures.append(draw_patches(values, patch=patch, border=border, shape=shape))
    return np.stack(pictures)


def find_corners(picture: ArrayLike) -> F64:
    """Return the corners (4, 2), (x, y) pixels, of the grid in a picture (H, W) where all patches are bright.

    All patches are bright in the first picture of a sequence. The corners are the bright pixels
    that are farthest along the diagonals, moved out by half a pixel, to the pixel's own corner.
    """
    message = "expected a picture (H, W) of a grid, bright on black"
    picture = np.asarray(picture, np.float64)
    if picture.ndim != 2 or not picture.max() > 0:
        raise InputError(message)
    y, x = np.nonzero(picture > picture.max() / 4)
    if np.ptp(x) == 0 or np.ptp(y) == 0:
        raise InputError(message)
    signs = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    farthest = [int(np.argmax(sx * x + sy * y)) for sx, sy in signs]
    return np.column_stack([x[farthest], y[farthest]]) + signs / 2


def read_blends(
    image: ArrayLike,
    corners: ArrayLike,
    schedule: Schedule = DEFAULT,
    *,
    core: float = 0.6,
    low: float = blends.MIN_BRIGHTNESS,
    high: float = blends.MAX_BRIGHTNESS,
) -> list[list[blends.Blend]]:
    """Return the blends of a photograph of the display: a list per channel, with a Blend per grid.

    `corners` are the outer corners of the corner patches of all grids together, see
    `chart.read_patches`; `core` is the part of a patch that is read; brightnesses between `low` and
    `high` are measurements.

    Raises
    ------
    ValueError
        As `chart.read_patches` and `mixing_ratios`.
    """
    grids = len(schedule.high)
    rows = schedule.rows
    columns = schedule.columns
    alpha = mixing_ratios(rows, columns, schedule.steps).ravel()
    gap = schedule.border / schedule.patch
    M = chart.read_patches(image, corners, grids * rows, columns, gap=gap, core=core)
    channels = np.moveaxis(M.reshape(grids, rows * columns, -1), -1, 0)
    return [
        [blends.make_blend(alpha, grid, low=low, high=high) for grid in channel]
        for channel in channels
    ]


def recover_display(P: ArrayLike, joined: blends.InverseResponse) -> tuple[F64, F64]:
    """Return the response of the display: pixel values (n + 1,), and their light over that of the largest.

    Blend j shows the pixel value P_j for a fraction alpha of the time and black for the rest. So
    s_j is the light of P_j above black, and several blends calibrate the screen as well as the
    camera [Wilburn08 sec. 6]. The first of the n + 1 values is black, 0.

    Raises
    ------
    ValueError
        If there is not one pixel value per blend.
    """
    P = np.asarray(P, np.float64)
    if P.shape != joined.s.shape:
        raise InputError(
            f"expected {len(joined.s)} pixel values, one per blend, got shape {P.shape}"
        )
    order = np.argsort(P)
    return np.r_[0.0, P[order]], np.r_[0.0, joined.s[order]] / joined.s[order[-1]]
