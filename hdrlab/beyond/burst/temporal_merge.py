"""Robust merge of aligned tiles in the Fourier domain (after Hasinoff et al., SIGGRAPH Asia 2016).

X        frames              (N, H, W) float32, linear, all of the same exposure; X_0 is the reference frame
T        tiles               (N, ..., n, n), those of frame z moved onto the reference
F        Fourier transform of a tile, (..., n, n) complex
sigma2   noise variance of a pixel of a tile, (...): lambda_s rms(T_0) + lambda_r
D_z      difference          F_0 - F_z; without motion it is noise, with mean |D_z|^2 = 2 n^2 sigma2
c        tuning constant: 0 keeps the reference frame, infinity averages all frames
A_z      shrinkage           |D_z|^2 / (|D_z|^2 + c 2 n^2 sigma2), 0 to 1, of each spatial frequency
w        raised cosine       (n,), 1/2 - 1/2 cos(2 pi (x + 1/2) / n); windows that overlap by half sum to 1

A_z is a Wiener filter's weight: a difference as large as the noise is averaged, a larger one is
motion or misalignment, where the reference is used alone.

The factor of n^2 comes from the sum over the pixels of a tile, and the factor of 2 from the two
frames. The implementation of Monod, Delon and Veit (IPOL 2021) also divides by 4^2, and has c = 8.
Here c = 1 means the noise itself. If the camera moves by whole pixels, c = 12 leaves at most 1.1 times the
noise of the mean of 8 frames. A real hand moves by fractions of a pixel, and then edges differ between the
frames: with c = 12 their error is about that of a single frame. The default of 4 is a compromise. It leaves
1.3 times the noise of the mean where nothing moves, and sharper edges. See tests/beyond/test_burst.py and
notebook 27.

The paper also denoises the merged tiles by a second filter, in space. It is not part of this module.
"""

from typing import Final

import numpy as np

from hdrlab.beyond.burst.tile_alignment import (
    TILE_SIDE,
    align,
    as_frames,
    cut_tiles,
    require_side,
    tile_grid,
)
from hdrlab.core.arrays import F32, F64, Array, ArrayLike, describe
from hdrlab.errors import InputError

TUNING: Final = 4.0
# keeps 0 / 0 out of A_z where a difference and the noise are both 0
SMALLEST_VARIANCE = 1e-30


def noise_variance(T0: Array, shot: float, read: float) -> Array:
    """Return sigma2 = lambda_s rms(T_0) + lambda_r, one number for each tile."""
    rms = np.sqrt(np.mean(np.square(T0), axis=(-2, -1)))
    return np.asarray(shot * rms + read)


def shrinkage(D: Array, variance: ArrayLike, tuning: float) -> Array:
    """Return A_z = |D_z|^2 / (|D_z|^2 + c 2 n^2 sigma2) of each frequency; n is the side of D."""
    side = D.shape[-2]
    power = D.real**2 + D.imag**2
    expected = 2 * side**2 * np.asarray(variance)[..., None, None]
    return np.asarray(power / (power + tuning * expected + SMALLEST_VARIANCE))


def merge_tile(T: Array, variance: ArrayLike, *, tuning: float) -> Array:
    """Return the inverse transform of 1/N sum_z (F_z + A_z D_z), a tile merged from N aligned ones.

    T (N, ..., n, n) are the tiles, the reference's first, and `variance` (...) is the noise variance
    of a pixel. The reference has D_0 = 0.
    """
    F = np.fft.rfft2(T)
    D = F[0] - F
    A = shrinkage(D, variance, tuning)
    return np.asarray(np.fft.irfft2(np.mean(F + A * D, axis=0), T.shape[-2:]))


def raised_cosine(side: int) -> F64:
    """Return w(x) = 1/2 - 1/2 cos(2 pi (x + 1/2) / n)."""
    x = np.arange(side)
    return np.asarray(0.5 - 0.5 * np.cos(2 * np.pi * (x + 0.5) / side))


def add_overlapping(tiles: Array, shape: tuple[int, int]) -> F32:
    """Return the image (H, W) in which each pixel is the sum of w(y) w(x) T over the four tiles on it."""
    rows, columns, side, _ = tiles.shape
    half = side // 2
    w = raised_cosine(side)
    windowed = tiles * np.outer(w, w)
    image = np.zeros(((rows + 1) * half, (columns + 1) * half))
    blocks = image.reshape(rows + 1, half, columns + 1, half).swapaxes(1, 2)
    for down in (0, 1):
        for right in (0, 1):
            quarter = windowed[..., down * half :, right * half :][..., :half, :half]
            blocks[down : down + rows, right : right + columns] += quarter
    return image[half : half + shape[0], half : half + shape[1]].astype(np.float32)


def merge(
    frames: ArrayLike,
    offsets: ArrayLike,
    *,
    shot: float,
    read: float,
    tuning: float = TUNING,
    tile_side: int = TILE_SIDE,
) -> F32:
    """Return the burst merged onto its first frame.

    Parameters
    ----------
    frames : (N, H, W) or (N, H, W, C), linear, all of the same exposure
    offsets : (N, R, C, 2) int
        (dy, dx) pixels of each tile, as of `tile_alignment.align`
    shot, read : float
        lambda_s and lambda_r of the noise variance lambda_s X + lambda_r of a pixel X, in the unit of
        the frames. For frames whose 1 is a full well of q electrons, with a read noise of s
        electrons, they are 1 / q and (s / q)^2.
    tuning : float
        c, at least 0. A small one keeps more of the reference frame: fewer ghosts, more noise.
    tile_side : int
        n, pixels, even, as for the alignment

    Returns
    -------
    merged : (H, W) or (H, W, C) float32

    Raises
    ------
    InputError
        For frames and offsets that do not fit, or a negative number.

    References
    ----------
    Hasinoff et al., Burst photography for high dynamic range and low-light imaging on mobile
    cameras, SIGGRAPH Asia 2016.

    Examples
    --------
    >>> frames = 0.5 + 0.01 * np.random.default_rng(0).standard_normal((8, 64, 64))
    >>> still = np.zeros((8, 9, 9, 2), int)
    >>> merged = merge(frames, still, shot=0.0, read=0.01**2)
    >>> float(np.round(frames[0].std() / merged.std(), 1))  # sqrt(8) = 2.8
    2.2
    """
    X = np.asarray(frames)
    if X.ndim == 4:
        planes = [
            merge(plane, offsets, shot=shot, read=read, tuning=tuning, tile_side=tile_side)
            for plane in np.moveaxis(X, -1, 0)
        ]
        return np.stack(planes, axis=-1)
    X = as_frames(X)
    require_side(tile_side)
    grid = tile_grid(X.shape[1:], tile_side)
    u = np.asarray(offsets)
    if u.shape != (len(X), *grid, 2) or u.dtype.kind not in "iu":
        raise InputError(
            f"expected whole offsets {(len(X), *grid, 2)}, one for each tile, got {describe(u)}"
        )
    if min(shot, read, tuning) < 0:
        raise InputError(f"expected {shot=}, {read=} and {tuning=} of at least 0")
    T = np.stack([cut_tiles(Xz, uz, tile_side) for Xz, uz in zip(X, u, strict=True)])
    variance = noise_variance(T[0], shot, read)
    merged = [merge_tile(T[:, row], variance[row], tuning=tuning) for row in range(grid[0])]
    return add_overlapping(np.stack(merged), X.shape[1:])


def align_and_merge(frames: ArrayLike, *, shot: float, read: float, tuning: float = TUNING) -> F32:
    """Return a burst, gray or in color, aligned on its first frame and merged; parameters as of `merge`.

    The frames are aligned by their gray values, the mean of the channels.
    """
    X = np.asarray(frames)
    gray = X.mean(axis=-1) if X.ndim == 4 else X
    return merge(X, align(gray), shot=shot, read=read, tuning=tuning)
