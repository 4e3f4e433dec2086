"""Tile alignment of a burst, coarse to fine (after Hasinoff et al., SIGGRAPH Asia 2016).

X        frames        (N, H, W) float32, linear, all of the same exposure; X_0 is the reference frame
g        level of a Gaussian pyramid of a frame, half the sides of the next finer one
T        tiles         (R, C, n, n) of n x n pixels, which overlap by half
u        offsets       (R, C, 2) int, (dy, dx) pixels: how far a tile of frame z must move, down and
                       right, to lie on the reference
r        search radius in pixels, of one level
distance of two tiles  L2: sum (T_0 - T_z)^2;  L1: sum |T_0 - T_z|

Tile (i, j) has its middle at pixel (i n / 2, j n / 2). So tile i of a fine level lies over tile i / 2
of the next coarser level. Beyond its border, a frame is continued by its outermost pixels.

The paper aligns a gray image of half the size. It refines the coarse offsets to fractions of a
pixel, and starts a fine tile from three coarse ones. Here all offsets are whole pixels, and a fine tile
starts from the coarse tile that it lies over or from one of its four neighbors.
"""

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F32, Array, ArrayLike, NDArray, describe
from hdrlab.core.filters import pyramid
from hdrlab.errors import InputError

Offsets = NDArray[np.int64]
Distance = Callable[[F32, F32], F32]

# pixels
TILE_SIDE = 16
LEVEL_COUNT = 4
# pixels of each level, from coarse to fine
SEARCH_RADII = (4, 2, 2, 1)
# rows and columns from a coarse tile to itself and to its neighbors
NEIGHBOURS = ((0, 0), (-1, 0), (1, 0), (0, -1), (0, 1))


class State(NamedTuple):
    """The offsets of one frame after a level of the pyramid.

    Attributes
    ----------
    level : int, 0 is the finest
    start : (R, C, 2), offsets from the coarser level, in pixels of this level
    offsets : (R, C, 2), offsets after the search
    """

    level: int
    start: Offsets
    offsets: Offsets


def tile_grid(shape: Sequence[int], side: int = TILE_SIDE) -> tuple[int, int]:
    """Return the rows R and columns C of tiles of an image (H, W).

    Examples
    --------
    >>> tile_grid((64, 96), 16)
    (9, 13)
    """
    half = side // 2
    return -(-shape[0] // half) + 1, -(-shape[1] // half) + 1


def cut_tiles(image: Array, offsets: ArrayLike, side: int = TILE_SIDE, margin: int = 0) -> Array:
    """Return T (R, C, n, n), cut from an image so that moved by the offsets they lie on the grid.

    With a margin, each tile has so many more pixels on all four sides.
    """
    u = np.asarray(offsets)
    reach = np.arange(side + 2 * margin) - side // 2 - margin
    middle_rows = np.arange(u.shape[0])[:, None] * (side // 2)
    middle_columns = np.arange(u.shape[1])[None, :] * (side // 2)
    rows = (middle_rows - u[..., 0])[..., None] + reach
    columns = (middle_columns - u[..., 1])[..., None] + reach
    rows = np.clip(rows, 0, image.shape[0] - 1)
    columns = np.clip(columns, 0, image.shape[1] - 1)
    return image[rows[..., :, None], columns[..., None, :]]


def l2_distance(T0: F32, Tz: F32) -> F32:
    """Return sum (T_0 - T_z)^2 over the pixels of each tile."""
    D = T0 - Tz
    return np.asarray(np.einsum("...yx,...yx->...", D, D))


def l1_distance(T0: F32, Tz: F32) -> F32:
    """Return sum |T_0 - T_z| over the pixels of each tile: one wrong pixel counts less than with L2."""
    return np.asarray(np.abs(T0 - Tz).sum(axis=(-2, -1)))


def candidates(coarse: Offsets, grid: tuple[int, int]) -> Offsets:
    """Return 2 u of the coarse tile below each fine tile and of its four neighbors, (5, R, C, 2)."""
    starts = []
    for down, right in NEIGHBOURS:
        rows = np.clip(np.arange(grid[0]) // 2 + down, 0, coarse.shape[0] - 1)
        columns = np.clip(np.arange(grid[1]) // 2 + right, 0, coarse.shape[1] - 1)
        starts.append(2 * coarse[rows[:, None], columns])
    return np.stack(starts)


def choose(T0: F32, image: F32, starts: Offsets, distance: Distance) -> Offsets:
    """Return for each tile the candidate u with the smallest distance from the reference tile."""
    side = T0.shape[-1]
    distances = [distance(T0, cut_tiles(image, u, side)) for u in starts]
    best = np.argmin(distances, axis=0)
    return np.asarray(np.take_along_axis(starts, best[None, ..., None], axis=0)[0])


def window_distances(T0: F32, image: F32, start: Offsets, radius: int, distance: Distance) -> F32:
    """Return the distances (2 r + 1, 2 r + 1, R, C) of all offsets within r pixels of the start.

    Entry (k, l) belongs to the offset start + (k - r, l - r).
    """
    side = T0.shape[-1]
    window = cut_tiles(image, start, side, radius)
    steps = range(2 * radius + 1)
    # A tile that is cut further down has to move up.
    rows = [
        [distance(T0, window[..., y : y + side, x : x + side]) for x in reversed(steps)]
        for y in reversed(steps)
    ]
    return np.array(rows)


def search(T0: F32, image: F32, start: Offsets, radius: int, distance: Distance) -> Offsets:
    """Return u = argmin distance(T_0, T_z(u)) over all offsets within r pixels of the start."""
    distances = window_distances(T0, image, start, radius, distance)
    width = 2 * radius + 1
    best = np.argmin(distances.reshape(width**2, *start.shape[:2]), axis=0)
    steps = np.stack(np.divmod(best, width), axis=-1) - radius
    return start + steps


def align_steps(
    reference: ArrayLike,
    frame: ArrayLike,
    *,
    tile_side: int = TILE_SIDE,
    radii: Sequence[int] = SEARCH_RADII,
) -> Iterator[State]:
    """Yield the State after each level, from the coarsest to the finest; parameters as of `align`."""
    X0, Xz = as_frames(np.asarray([reference, frame]))
    require_side(tile_side)
    levels0 = pyramid.gaussian(X0, len(radii))
    levels_z = pyramid.gaussian(Xz, len(radii))
    coarsest = len(levels0) - 1
    offsets = np.zeros((*tile_grid(levels0[coarsest].shape, tile_side), 2), np.int64)
    for level in range(coarsest, -1, -1):
        g0 = levels0[level]
        gz = levels_z[level]
        grid = tile_grid(g0.shape, tile_side)
        T0 = cut_tiles(g0, np.zeros((*grid, 2), np.int64), tile_side)
        distance = l1_distance if level == 0 else l2_distance
        start = offsets
        if level < coarsest:
            start = choose(T0, gz, candidates(offsets, grid), l1_distance)
        offsets = search(T0, gz, start, radii[-1 - level], distance)
        yield State(level, start, offsets)


def align(
    frames: ArrayLike, *, tile_side: int = TILE_SIDE, radii: Sequence[int] = SEARCH_RADII
) -> Offsets:
    """Return the offset of each tile of each frame to the first frame, the reference.

    Parameters
    ----------
    frames : (N, H, W), linear, all of the same exposure
        For a burst in color, pass its gray frames.
    tile_side : int
        n, pixels, even
    radii : sequence of int
        r of each level of the pyramid, from coarse to fine. The last one belongs to the frame itself.
        Offsets of up to about sum r_k 2^k pixels are found.

    Returns
    -------
    offsets : (N, R, C, 2) int64
        (dy, dx) pixels: how far each tile must move, down and right, to lie on the reference. Those
        of the reference are 0.

    Raises
    ------
    InputError
        For frames that are no stack of finite images, or an odd side.

    References
    ----------
    Hasinoff et al., Burst photography for high dynamic range and low-light imaging on mobile
    cameras, SIGGRAPH Asia 2016.

    Examples
    --------
    >>> scene = np.random.default_rng(0).random((80, 80), np.float32)
    >>> offsets = align([scene[8:72, 8:72], scene[5:69, 10:74]])
    >>> offsets[1, 4, 4].tolist()  # the second frame saw the scene 3 pixels higher and 2 further right
    [-3, 2]
    """
    X = as_frames(frames)
    grid = tile_grid(X.shape[1:], tile_side)
    offsets = [np.zeros((*grid, 2), np.int64)]
    for Xz in X[1:]:
        *_, finest = align_steps(X[0], Xz, tile_side=tile_side, radii=radii)
        offsets.append(finest.offsets)
    return np.stack(offsets)


def as_frames(frames: ArrayLike) -> F32:
    """Return frames (N, H, W) as float32, or raise an InputError."""
    X = np.asarray(frames)
    is_stack = X.ndim == 3 and X.size > 0 and X.dtype.kind in "uif"
    if not is_stack or not np.isfinite(X).all():
        raise InputError(f"expected finite frames (N, H, W) of a burst, got {describe(X)}")
    return X.astype(np.float32)


def require_side(side: int) -> None:
    """Raise an InputError unless a tile can overlap its neighbors by half."""
    if side < 2 or side % 2:
        raise InputError(f"expected tiles with an even side of at least 2 pixels, got {side}")
