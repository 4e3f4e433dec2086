"""Measure at full resolution, in a few tiles, how far a photo is still displaced.

A level of an image pyramid that is shifted by a fraction of its pixels is blurred by interpolation,
and an average of pixel values at an edge has another rank in a darker photo. Both look like a small
displacement, which is multiplied by the scale of the level. Tiles of the photos themselves have
neither fault, and cost the same for an image of any size.

tiles  (TILES_PER_SIDE, TILES_PER_SIDE, side, side): an even grid over the area that both photos show
"""

from dataclasses import replace

import numpy as np
import scipy

from hdrlab.align.light import SMOOTHING_SIGMA
from hdrlab.core.arrays import F32, F64, Array
from hdrlab.core.filters import warp
from hdrlab.pipeline import rigid_motion
from hdrlab.pipeline.rigid_motion import BLOCKS_PER_SIDE, Fit

# tiles a side of the image: a multiple of the blocks
TILES_PER_SIDE = 2 * BLOCKS_PER_SIDE
# The tiles of a quick check hold this fraction of the pixels, within limits of their side.
QUICK_FRACTION = 1 / 16
MIN_QUICK_SIDE_PIXELS = 16
MAX_QUICK_SIDE_PIXELS = 32
# side of the tiles in which a motion is refined
SIDE_PIXELS = 64
# pixels around a tile, in which it is smoothed
MARGIN_PIXELS = 3
# A motion is refined in that many steps, or until a step is shorter than so many pixels.
MAX_STEPS = 6
MIN_STEP_PIXELS = 0.02


def quick_side(shape: tuple[int, ...]) -> int:
    """Return the side of the tiles of a quick check, in pixels."""
    side = round(np.sqrt(QUICK_FRACTION * shape[0] * shape[1]) / TILES_PER_SIDE)
    return min(max(side, MIN_QUICK_SIDE_PIXELS), MAX_QUICK_SIDE_PIXELS)


def check(dark: Array, bright: Array, H: F64, side: int) -> Fit:
    """Return the Fit of two gray photos (h, w) of 8 bits in tiles, for a motion H.

    `side` is the side of a tile in pixels. Photos in whose overlap the tiles have no place are
    without structure, and photos that are smaller than a tile are not usable.
    """
    shape = bright.shape
    padded = side + 2 * MARGIN_PIXELS
    if padded > min(shape):
        nothing = np.zeros(0)
        return Fit(H=H, next=H, step=0.0, usable=0.0, similarity=0.0, shifts=nothing, scale=1)
    starts = _place_tiles(H, shape, padded)
    rows = starts[0][:, None] + np.arange(padded)
    columns = starts[1][:, None] + np.arange(padded)
    fixed = bright[rows[:, None, :, None], columns[None, :, None, :]]
    moved = _sample(dark, H, rows, columns)
    is_seen = np.isfinite(moved)
    levels = np.zeros(fixed.shape, np.uint8)
    levels[is_seen] = np.rint(moved[is_seen])
    level = rigid_motion.match_ranks(levels, fixed, levels[is_seen], fixed[is_seen])
    moved = np.clip(moved, level.low, level.high)
    level = replace(level, fixed=_smooth(level.fixed))
    radius = np.hypot(shape[0], shape[1]) / 2
    inner = slice(MARGIN_PIXELS, -MARGIN_PIXELS)
    y = (rows[:, inner] - (shape[0] - 1) / 2)[:, None, :, None] / radius
    x = (columns[:, inner] - (shape[1] - 1) / 2)[None, :, None, :] / radius
    return rigid_motion.fit_moved(
        level,
        _smooth(moved),
        H,
        1,
        shape=shape,
        y=y.astype(np.float32),
        x=x.astype(np.float32),
        sum_blocks=_sum_blocks,
    )


def refine(dark: Array, bright: Array, H: F64) -> Fit:
    """Return the Fit at the end of steps from a motion H that is nearly right."""
    found = check(dark, bright, H, SIDE_PIXELS)
    for _ in range(MAX_STEPS):
        if found.step <= MIN_STEP_PIXELS:
            break
        found = check(dark, bright, found.next, SIDE_PIXELS)
    return found


def _place_tiles(H: F64, shape: tuple[int, ...], side: int) -> tuple[Array, Array]:
    """Return the first rows and first columns (TILES_PER_SIDE,) of tiles in the area that both show."""
    height, width = shape
    corners = warp.apply(H, warp.corners(shape))
    left, top = np.ceil(corners.min(axis=0)).astype(int)
    right, bottom = np.floor(corners.max(axis=0)).astype(int)
    starts = []
    for first, last, length in ((top, bottom, height), (left, right, width)):
        low = min(max(first, 0), length - side)
        high = max(min(last + 1, length) - side, low)
        starts.append(np.linspace(low, high, TILES_PER_SIDE).astype(int))
    return starts[0], starts[1]


def _sample(image: Array, H: F64, rows: Array, columns: Array) -> F32:
    """Return an image that was moved by H at rows (n, h) and columns (m, w): (n, m, h, w)."""
    offset = np.rint(H[1::-1, 2]).astype(int)
    is_shift = np.allclose(H, warp.as_homographies([offset])[0], rtol=0, atol=1e-6)
    rows = rows[:, None, :, None]
    columns = columns[None, :, None, :]
    if is_shift:
        rows = rows - offset[0]
        columns = columns - offset[1]
        is_inside = (rows >= 0) & (rows < image.shape[0])
        is_inside = is_inside & (columns >= 0) & (columns < image.shape[1])
        if is_inside.all():
            return image[rows, columns].astype(np.float32)
        sampled = image[rows % image.shape[0], columns % image.shape[1]].astype(np.float32)
        sampled[~is_inside] = np.nan
        return sampled
    y, x = np.broadcast_arrays(rows, columns)
    sources = warp.apply(np.linalg.inv(H), np.stack([x.ravel(), y.ravel()], axis=-1))
    sampled = scipy.ndimage.map_coordinates(
        image, sources.T[::-1], np.float32, order=1, mode="constant", cval=np.nan
    )
    return np.asarray(sampled.reshape(y.shape))


def _smooth(tiles: F32) -> F32:
    """Return tiles smoothed by a Gaussian, without the margin around them.

    SciPy's filter does the same, but its import would take longer than the check of a small bracket.
    """
    offsets = np.arange(-MARGIN_PIXELS, MARGIN_PIXELS + 1)
    weights = np.exp(-((offsets / SMOOTHING_SIGMA) ** 2) / 2).astype(np.float32)
    weights /= weights.sum()
    height, width = (side - 2 * MARGIN_PIXELS for side in tiles.shape[2:])
    rows = np.zeros((*tiles.shape[:2], height, tiles.shape[3]), np.float32)
    for k, weight in enumerate(weights):
        rows += weight * tiles[:, :, k : k + height]
    smoothed = np.zeros((*tiles.shape[:2], height, width), np.float32)
    for k, weight in enumerate(weights):
        smoothed += weight * rows[..., k : k + width]
    return smoothed


def _sum_blocks(terms: F32, w: F32) -> F64:
    """Return N (blocks, 5, 5) of terms (5, TILES_PER_SIDE, TILES_PER_SIDE, h, w)."""
    tiles_per_block = TILES_PER_SIDE // BLOCKS_PER_SIDE
    shape = (len(terms), BLOCKS_PER_SIDE, tiles_per_block, BLOCKS_PER_SIDE, tiles_per_block, -1)
    columns = np.moveaxis(terms.reshape(shape), 2, 3).reshape(len(terms), BLOCKS_PER_SIDE**2, -1)
    weights = np.moveaxis(w.reshape(shape[1:]), 1, 2).reshape(BLOCKS_PER_SIDE**2, -1)
    by_block = np.moveaxis(columns, 1, 0)
    return np.asarray((by_block * weights[:, None]) @ np.moveaxis(by_block, 1, 2), np.float64)
