"""By how much a photo is shifted against another one, so that their rows can be compared.

A   a photo, its gray values replaced by their ranks   (H, W), from -1/2 to 1/2
F   its Fourier transform
R   phase correlation, the inverse transform of F1 F2* / |F1 F2*|

Ranks make photos of different exposures alike. R has a peak at the shift, also where a part of one
photo shows something else: that part only adds noise to R. A large photo is searched in a small
copy first, and then in a few tiles at full resolution.
"""

import numpy as np

from hdrlab.core.arrays import F32, F64, Array, Flags

# longer side of the small copy, in pixels
MAX_SIDE_PIXELS = 512
# side of a tile at full resolution, and tiles along each side of the photo
TILE_PIXELS = 256
TILES_PER_SIDE = 3
# fraction of each side, at both ends, over which the weights fall to 0
FADING_FRACTION = 0.1
# pixels of the correlation; finer detail is mostly noise
SMOOTHING_PIXELS = 1.0


def measure_shift(moving: Flags, fixed: Flags) -> tuple[int, int]:
    """Return (dy, dx) in whole pixels: moving[y, x] shows what fixed[y + dy, x + dx] shows.

    Parameters
    ----------
    moving, fixed : (H, W) uint8
        Two photos of one scene. Where they have nothing in common, the result means nothing.

    Examples
    --------
    >>> scene = np.random.default_rng(0).integers(0, 200, (40, 60)).astype(np.uint8)
    >>> measure_shift(scene[3:, 5:], scene[:-3, :-5])
    (3, 5)
    """
    step = -(-max(fixed.shape) // MAX_SIDE_PIXELS)
    small_dy, small_dx = _find_peak([_correlate(_reduce(moving, step), _reduce(fixed, step))])
    coarse = (step * small_dy, step * small_dx)
    if step == 1:
        return coarse
    surfaces = []
    for row in range(TILES_PER_SIDE):
        for column in range(TILES_PER_SIDE):
            tiles = _cut_tiles(moving, fixed, coarse, row, column)
            if tiles is not None:
                surfaces.append(_correlate(*tiles))
    if not surfaces:
        return coarse
    fine_dy, fine_dx = _find_peak(surfaces)
    if max(abs(fine_dy), abs(fine_dx)) > step:
        return coarse
    return coarse[0] + fine_dy, coarse[1] + fine_dx


def _reduce(photo: Flags, step: int) -> Array:
    """Return the means of square blocks."""
    if step == 1:
        return photo
    height = photo.shape[0] // step
    width = photo.shape[1] // step
    blocks = photo[: height * step, : width * step].reshape(height, step, width, step)
    return blocks.mean(axis=(1, 3)).astype(np.uint8)


def _cut_tiles(
    moving: Flags, fixed: Flags, shift: tuple[int, int], row: int, column: int
) -> tuple[Flags, Flags] | None:
    """Return a tile of both photos that shows the same up to a few pixels; None if it has no place."""
    top = (fixed.shape[0] - TILE_PIXELS) * (2 * row + 1) // (2 * TILES_PER_SIDE)
    left = (fixed.shape[1] - TILE_PIXELS) * (2 * column + 1) // (2 * TILES_PER_SIDE)
    moving_top = top - shift[0]
    moving_left = left - shift[1]
    if min(top, left, moving_top, moving_left) < 0:
        return None
    tile = fixed[top : top + TILE_PIXELS, left : left + TILE_PIXELS]
    moving_tile = moving[
        moving_top : moving_top + TILE_PIXELS, moving_left : moving_left + TILE_PIXELS
    ]
    return (moving_tile, tile) if tile.shape == moving_tile.shape else None


def _correlate(moving: Array, fixed: Array) -> F32:
    """Return the phase correlation R of two photos of one size."""
    product = np.fft.rfft2(_window_ranks(fixed)) * np.conj(np.fft.rfft2(_window_ranks(moving)))
    rows = np.fft.fftfreq(fixed.shape[0])[:, None]
    columns = np.fft.rfftfreq(fixed.shape[1])
    smooth = np.exp(-2 * (np.pi * SMOOTHING_PIXELS) ** 2 * (rows**2 + columns**2))
    whitened = product / np.maximum(np.abs(product), 1e-9)
    return np.fft.irfft2(whitened * smooth, fixed.shape).astype(np.float32)


def _window_ranks(photo: Array) -> F32:
    """Return A, which fades to 0 at the edges of the photo."""
    counts = np.bincount(photo.ravel(), minlength=256)
    middles = (np.cumsum(counts) - counts / 2) / photo.size - 0.5
    window = _fade(photo.shape[0])[:, None] * _fade(photo.shape[1])
    return (middles[photo] * window).astype(np.float32)


def _fade(length: int) -> F64:
    """Return the weights of the pixels along a side: 1, and less near the ends.

    Most are 1, because a damaged band in the middle must not weigh more than the rest.
    """
    distance = np.minimum(np.arange(length) + 0.5, length - 0.5 - np.arange(length))
    return np.asarray(np.minimum(1, distance / (FADING_FRACTION * length)))


def _find_peak(surfaces: list[F32]) -> tuple[int, int]:
    """Return (dy, dx) at the highest peak of the sum of correlations."""
    total = np.sum(surfaces, axis=0)
    height, width = total.shape
    y, x = divmod(int(np.argmax(total)), width)
    dy = y - height if y > height // 2 else y
    dx = x - width if x > width // 2 else x
    return dy, dx
