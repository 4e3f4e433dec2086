"""How much of the image moved between the photos?

x    ln E           (P, H, W, C), of each photo alone: g(Z) - ln t
w    weights        (P, H, W, C), of pixel values that are neither clipped nor black
r    residuals      x - (sum_j w x) / (sum_j w)
R    of a block     (P, h, w), sum w r / sum w over its pixels and channels, so that noise averages out, less
                    the photo's median: where a photo is off as a whole, its time or the response is
                    wrong. The median of a photo and the mean of a block are subtracted in turns
                    (median polish), because not every photo measures every block
d    deviation      (h, w), sqrt(sum_j W R^2 / sum_j W), W the sum of w over the block
b    of a row       (P, h), sum w r / sum w over a row of blocks, less the photo's best cubic in y

Leaves, water and people make d large where they are. Most pixels of each value agree all the same,
so a median over pixel values, as in `consistency`, does not notice them. An edge that is off by a
pixel makes d large along a line; what counts is at least two blocks wide and high.

Beside clipped pixels, the photos of a still scene differ: JPEG and sharpening carry light from a
bright pixel to its neighbors, but less in a photo that clips it. So a photo does not measure the
pixels beside its clipped ones. Without this, 0.034 of the blocks of a still chapel deviate.

Lamps flicker, and most cameras read out row after row: then b has bands, and the same of columns
has none. A sky above the ground, where the response is a little wrong, makes no bands, because a
cubic explains it.
"""

from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from hdrlab.core.arrays import F32, Array, ArrayLike, as_mask
from hdrlab.diagnostics.frame_choice import choose_spread_frames
from hdrlab.diagnostics.overview import make_overview
from hdrlab.radiance.merge import CLIPPING_LEVEL, as_tables

# pixels of the overview that is compared
MAX_PIXELS = 180_000
# photos, spread over the exposure times, that are compared
MAX_COMPARED_PHOTOS = 64
# side of a block, in pixels of the overview
BLOCK_SIDE = 4
# pixels of the overview, across and along, within which a clipped pixel changes its neighbors
CLIPPING_REACH = 2
# mean weight, relative to the highest, with which a photo measures a block
MIN_BLOCK_WEIGHT = 0.2
# ln E by which the photos of a still scene may differ in a block: 0.2 stops
MAX_STILL_DEVIATION = 0.2 * np.log(2)
# turns of subtracting the photos' medians and the blocks' means
POLISH_TURNS = 10
# If two photos measure a smaller fraction of the blocks, nothing is known.
MIN_MEASURED_FRACTION = 0.1
# Fraction of the measured blocks. In still scenes, scanned film included, up to 0.001 deviate.
MIN_MOVING_FRACTION = 0.006
# stops of b; still scenes under steady light stay below 0.04
MIN_BAND_STOPS = 0.055
# Under flickering lamps, up to 0.02 of the blocks of a still scene deviate.
MAX_FLICKER_FRACTION = 0.03
# Bands do not count if b is less than the first number times what columns show, and fully from the
# second one on. In between they count in part, so that a small change of the photos never changes
# the measure by much. Still scenes stay below 1.8.
MIN_ROWS_OVER_COLUMNS = 2.25
FULL_ROWS_OVER_COLUMNS = 2.75


class Motion(NamedTuple):
    """The fraction of the image that moved, and the stops by which its light changes in bands."""

    fraction: float
    band_stops: float


def measure_motion(
    images: ArrayLike,
    times: ArrayLike,
    g: ArrayLike,
    w: ArrayLike,
    *,
    valid: ArrayLike | None = None,
) -> Motion:
    """Measure the fraction of the image that moved, and bands of flickering light.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Aligned photos.
    times : (P,) float
        Exposure times in seconds.
    g : (n,) or (n, 3) float
        Response, ln exposure of each pixel value.
    w : (n,) float
        Weights of the pixel values.
    valid : (P, H, W) bool, optional
        False where a photo has no image.

    Returns
    -------
    fraction, band_stops : float
        The fraction is that of the blocks that two photos measure; 0 where these are few. Above
        MIN_MOVING_FRACTION, something moved, or lamps flicker: see `causes`. Of more than
        MAX_COMPARED_PHOTOS photos, so many are compared. The bands are the RMS of b in stops, 0
        unless it is MIN_ROWS_OVER_COLUMNS times that of columns. Above MIN_BAND_STOPS, lamps
        flicker.

    Raises
    ------
    InputError
        If the arrays do not fit together.

    Examples
    --------
    >>> from hdrlab.capture import movers, responses
    >>> wall = np.full((60, 90), 0.5, np.float32)
    >>> ball = movers.ball((60, 90), (30, 45), 12, 2.0)
    >>> g = responses.true_g("film")
    >>> for step in (0, 30):
    ...     taken = movers.shoot(wall, ball, movers.path(3, (0, step)), [0.25, 0.5, 1.0]).bracket
    ...     motion = measure_motion(taken.images, taken.times, g, np.ones(256))
    ...     motion.fraction > MIN_MOVING_FRACTION
    False
    True
    """
    stack, times_s, w, curves, top = as_tables(images, times, g, w, "log", CLIPPING_LEVEL)
    mask = as_mask(valid, stack)
    by_time = np.argsort(times_s, kind="stable")
    frames = by_time[choose_spread_frames(times_s[by_time], MAX_COMPARED_PHOTOS)]
    times_s = times_s[frames]
    channel_count = curves.shape[1]
    small = make_overview(stack, curves, top=top, valid=mask, max_pixels=MAX_PIXELS, frames=frames)
    Z = np.moveaxis(small.images.reshape(*small.images.shape[:3], -1), -1, 0).copy()
    is_seen = (Z < top).all(axis=0)
    if small.valid is not None:
        is_seen = is_seen & small.valid
    relative_weights = np.where(np.arange(len(w)) > 0, w / w.max(), 0).astype(np.float32)
    R, W = _sum_residuals(Z, curves, times_s, relative_weights, np.asarray(is_seen))
    rows = measure_bands(R.sum(axis=2), W.sum(axis=2), channel_count * R.shape[2])
    columns = measure_bands(R.sum(axis=1), W.sum(axis=1), channel_count * R.shape[1])
    is_clear = minimum_around(np.asarray(is_seen), CLIPPING_REACH)
    R, W = _sum_residuals(Z, curves, times_s, relative_weights, is_clear)
    fraction = _measure_moving_fraction(R, W, MIN_BLOCK_WEIGHT * BLOCK_SIDE**2 * channel_count)
    return Motion(fraction, rows * _weigh_rows(rows, columns))


def _weigh_rows(rows: float, columns: float) -> float:
    """Return how much bands of rows count, from 0 to 1, if columns have such bands, too."""
    excess = rows - MIN_ROWS_OVER_COLUMNS * columns
    span = (FULL_ROWS_OVER_COLUMNS - MIN_ROWS_OVER_COLUMNS) * columns
    if excess >= span:
        return 1.0
    return max(excess / span, 0.0)


def _sum_residuals(
    Z: Array, curves: Array, times: Array, relative_weights: F32, is_seen: Array
) -> tuple[F32, F32]:
    """Return the sums of w r and of w over the pixels and channels of each block, (P, h, w)."""
    shape = (len(times), *(n // BLOCK_SIDE for n in Z.shape[2:]))
    R = np.zeros(shape, np.float32)
    W = np.zeros(shape, np.float32)
    log_times = np.log(times).astype(np.float32)[:, None, None]
    for values, curve in zip(Z, curves.T.astype(np.float32), strict=True):
        weights = relative_weights.take(values) * is_seen
        r = curve.take(values) - log_times
        r -= (weights * r).sum(axis=0) / np.maximum(weights.sum(axis=0), 1e-9)
        R += sum_blocks(weights * r)
        W += sum_blocks(weights)
    return R, W


def _measure_moving_fraction(R: F32, W: F32, min_weight: float) -> float:
    """Return the fraction of the blocks that moved; R and W are overwritten."""
    W[W < min_weight] = 0
    R /= np.maximum(W, 1e-9)
    weight_sums = np.maximum(W.sum(axis=0), 1e-9)
    for _ in range(POLISH_TURNS):
        R -= (W * R).sum(axis=0) / weight_sums
        for block_residuals, block_weights in zip(R, W, strict=True):
            if block_weights.any():
                block_residuals -= np.median(block_residuals[block_weights > 0])
    deviation = np.sqrt((W * R**2).sum(axis=0) / weight_sums)
    is_measured = (W > 0).sum(axis=0) > 1
    if not is_measured.sum() > MIN_MEASURED_FRACTION * is_measured.size:
        return 0.0
    # Of the blocks that deviate, those in a square of 2 x 2 count.
    deviates = np.pad(is_measured & (deviation > MAX_STILL_DEVIATION), 1)
    is_square = sliding_window_view(deviates, (2, 2)).all(axis=(2, 3))
    has_moved = sliding_window_view(is_square, (2, 2)).any(axis=(2, 3))
    return float(has_moved.sum() / is_measured.sum())


def measure_bands(R: F32, W: F32, count: int) -> float:
    """Return the RMS of b in stops.

    R and W are the sums of w r and of w (P, n), each over `count` blocks and channels.
    """
    W = np.where(W > MIN_BLOCK_WEIGHT / 2 * BLOCK_SIDE**2 * count, W, 0)
    b = R / np.maximum(W, 1e-9)
    powers = np.vander(np.linspace(-1, 1, R.shape[1]), 4)
    for row_means, root_weights in zip(b, np.sqrt(W), strict=True):
        weighted = root_weights[:, None] * powers
        cubic = np.linalg.lstsq(weighted, root_weights * row_means, rcond=None)[0]
        row_means -= powers @ cubic
    W[:, (W > 0).sum(axis=0) < 2] = 0
    return float(np.sqrt((W * b**2).sum() / max(W.sum(), 1e-9)) / np.log(2))


def minimum_around(values: Array, reach: int) -> Array:
    """Return the minimum of the elements at most `reach` away in each of the last two directions.

    SciPy's filter does the same, but its import would take longer than all diagnostics of a small bracket.

    Examples
    --------
    >>> minimum_around(np.array([[9, 9, 9, 9], [9, 9, 9, 0]]), 1).tolist()
    [[9, 9, 0, 0], [9, 9, 0, 0]]
    """
    if not values.size:
        return values
    for axis in (-2, -1):
        width = [(0, 0)] * values.ndim
        width[axis] = (reach, reach)
        padded = np.pad(values, width, mode="edge")
        values = sliding_window_view(padded, 2 * reach + 1, axis).min(axis=-1)
    return values


def sum_blocks(values: Array) -> F32:
    """Return the sums over square blocks of side BLOCK_SIDE, (P, h, w)."""
    h = values.shape[1] // BLOCK_SIDE
    w = values.shape[2] // BLOCK_SIDE
    rows = (
        values[:, : h * BLOCK_SIDE]
        .reshape(len(values), h, BLOCK_SIDE, values.shape[2])
        .sum(axis=2, dtype=np.float32)
    )
    return np.asarray(
        sum(rows[..., k : w * BLOCK_SIDE : BLOCK_SIDE] for k in range(BLOCK_SIDE)), np.float32
    )
