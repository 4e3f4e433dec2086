"""What a display shows during one exposure, to make blends of two lights (Wilburn et al., CVPR 2008, sec. 3).

P_hi, P_lo  pixel values          the two that a patch shows, 0 to 255
T           steps                 pictures in a sequence: 15, of four frames each, at 60 Hz in one second
k           number of a patch     1 ... rows columns, row by row in its grid
alpha       share of P_hi         (rows, columns): k / T

Patch k shows P_hi in the first k pictures and P_lo in the others: it switches once a sequence, so what a
display does while it switches is the same for every patch, and little of it. A sequence may be repeated
without a pause: an exposure as long as the sequence then holds all of it, wherever it begins.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.calibration.blends import HIGH, LOW, Blend, blend
from hdrlab.calibration.patch_grid import read

Float = NDArray[np.float64]


def shares(rows: int = 3, columns: int = 5, steps: int = 15) -> Float:
    """Return alpha = k / T (rows, columns) [Wilburn08 eq. 4].

    Raises
    ------
    ValueError
        For more patches than steps, of which some would look alike.

    Examples
    --------
    >>> shares(2, 2, 4)
    array([[0.25, 0.5 ],
           [0.75, 1.  ]])
    """
    if rows < 1 or columns < 1 or steps < rows * columns:
        raise ValueError(
            f"expected a grid and at least as many steps as patches, got {rows} x {columns} and {steps}"
        )
    return np.arange(1, rows * columns + 1).reshape(rows, columns) / steps


def frames_per_step(refresh: float = 60.0, exposure: float = 1.0, steps: int = 15) -> int:
    """Return how many frames of the display a picture stands: refresh exposure / T, whole and even.

    Even, since liquid crystals are driven by a voltage whose sign changes every frame: brightness may differ
    between the two, and a picture should hold as many of either.

    Raises
    ------
    ValueError
        Where it is not; the message names exposures that would do.

    Examples
    --------
    >>> frames_per_step(60, 1, 15)
    4
    """
    if not (refresh > 0 and exposure > 0 and steps > 0):
        raise ValueError(
            f"expected a positive refresh rate, exposure and steps, got {refresh, exposure, steps}"
        )
    frames = refresh * exposure / steps
    nearest = max(2 * round(frames / 2), 2)
    if abs(frames - nearest) > 1e-6 * nearest:
        raise ValueError(
            f"expected an even number of frames per step, got {frames:.4g}: "
            f"expose for {nearest * steps / refresh:.6g} s, which makes it {nearest}"
        )
    return nearest


def levels_at(step: int, high: Sequence[int], low: int, alpha: Float, steps: int) -> NDArray[np.uint8]:
    """Return the pixel values (rows len(high), columns) of a step: P_hi while step < alpha T, then P_lo."""
    on = step < np.round(alpha * steps)
    return np.vstack([np.where(on, one, low) for one in high]).astype(np.uint8)


def draw(values: NDArray[np.uint8], *, patch: int, border: int, shape: tuple[int, int]) -> NDArray[np.uint8]:
    """Return a picture of `shape` with the patches in its middle, `patch` wide, `border` of black between.

    Without the black, the light of bright neighbours would spill into a patch [Wilburn08 sec. 3].
    """
    cell = np.zeros((patch + border, patch + border), np.uint8)
    cell[:patch, :patch] = 1
    grid = np.kron(values, cell)[: -border or None, : -border or None]
    picture = np.zeros(shape, np.uint8)
    top, left = ((whole - part) // 2 for whole, part in zip(shape, grid.shape, strict=True))
    picture[top : top + grid.shape[0], left : left + grid.shape[1]] = grid
    return picture


def pictures(
    high: Sequence[int] = (220, 100),
    low: int = 0,
    *,
    rows: int = 3,
    columns: int = 5,
    steps: int = 15,
    patch: int = 30,
    border: int = 30,
    shape: tuple[int, int] = (480, 640),
) -> NDArray[np.uint8]:
    """Return the pictures (T, H, W) of a sequence; one grid per value of `high`, one under the other.

    Parameters
    ----------
    high, low : pixel values
        P_hi of each grid, and P_lo; the brightest should just saturate the camera.
    rows, columns : int
        Of each grid.
    steps : int
        T.
    patch, border : int
        Widths in display pixels; the border is black.
    shape : (H, W)
        Of the pictures.

    Raises
    ------
    ValueError
        For values that are no pixel values, P_hi not above P_lo, or grids that do not fit.

    Examples
    --------
    >>> shown = pictures((255,), rows=1, columns=2, steps=2, patch=1, border=1, shape=(1, 3))
    >>> shown.tolist()
    [[[255, 0, 255]], [[0, 0, 255]]]
    """
    if not high or not all(0 <= low < one <= 255 for one in high):
        raise ValueError(f"expected pixel values 0 <= low < high <= 255, got {low} and {list(high)}")
    if patch < 1 or border < 0:
        raise ValueError(
            f"expected patches of 1 pixel or more and no negative border, got {patch} and {border}"
        )
    alpha = shares(rows, columns, steps)
    need = [count * (patch + border) - border for count in (rows * len(high), columns)]
    if need[0] > shape[0] or need[1] > shape[1]:
        raise ValueError(
            f"expected pictures of at least {need[0]} x {need[1]} pixels for these grids, got {shape}"
        )
    shown = [levels_at(step, high, low, alpha, steps) for step in range(steps)]
    return np.stack([draw(one, patch=patch, border=border, shape=shape) for one in shown])


def outline(picture: ArrayLike) -> Float:
    """Return the corners (4, 2), (x, y) pixels, of the grid in a picture (H, W) where all patches are bright.

    So they are in the first picture of a sequence. The corners are the bright pixels farthest along the
    diagonals; half a pixel out, for a pixel has a width.
    """
    bright = np.asarray(picture, np.float64)
    y, x = np.nonzero(bright > bright.max() / 4)
    if bright.ndim != 2 or not bright.max() > 0 or np.ptp(x) == 0 or np.ptp(y) == 0:
        raise ValueError("expected a picture (H, W) of a grid, bright on black")
    signs = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    far = [int(np.argmax(sx * x + sy * y)) for sx, sy in signs]
    return np.column_stack([x[far], y[far]]) + signs / 2


def read_blends(
    image: ArrayLike,
    corners: ArrayLike,
    *,
    grids: int = 2,
    rows: int = 3,
    columns: int = 5,
    steps: int = 15,
    gap: float = 1.0,
    core: float = 0.6,
    low: float = LOW,
    high: float = HIGH,
) -> list[list[Blend]]:
    """Return the blends of a photograph of the display: a list per channel, with a Blend per grid.

    `corners` are the outer corners of the corner patches of all grids together, see `patches.read`; `gap` is
    the border over the patch, `core` the part of a patch that is read; `low` and `high` bound what is taken
    for a measurement.

    Raises
    ------
    ValueError
        As `patches.read` and `shares`.
    """
    alpha = shares(rows, columns, steps).ravel()
    M = read(image, corners, rows * grids, columns, gap=gap, core=core).reshape(grids, rows * columns, -1)
    return [[blend(alpha, M[j, :, c], low=low, high=high) for j in range(grids)] for c in range(M.shape[-1])]
