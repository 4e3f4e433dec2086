"""Assorted pixels: a mosaic of exposures on one sensor.

Nayar and Mitsunaga, CVPR 2000; Narasimhan and Nayar, PAMI 2005.

E      radiance        (H, W) or (H, W, 3), in the unit that fills a pixel of transparency 1
e      transparency    (H, W), 0 to 1, of the filter in front of each pixel
c      channel         (H, W) int, 0 to 2: the colour of each pixel; None on a gray sensor
X      exposure        (H, W), X = e E_c; a pixel is full at 1
Z      level           (H, W) uint8 or uint16
w      weight          (H, W), 1 / variance of Z / e; 0 where a pixel is full
E^     reconstruction  (G w Z / e) / (G w), G a Gaussian: a mean of the neighbours that measure it

One photograph covers the range of a bracket, at the cost of sharpness: only pixels with dark
filters measure strong light, and only those with clear filters weak light. The range grows by
log10(max e / min e) decades at the bright end. It loses 0.3 decades, a factor of 2, at the dark
end, where only every fourth pixel measures. Periods below four pixels alias in any light.
"""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.core.arrays import F64, Array, ArrayLike, as_radiance, describe, levels
from hdrlab.core.filters.mosaic import BAYER, as_channels, sample
from hdrlab.errors import InputError

# four transparencies, two stops apart, in a square
FOUR_EXPOSURES = np.array([[1.0, 1 / 4], [1 / 64, 1 / 16]])
# of the highest level: from here a pixel may have been full
CLIPPING_LEVEL = 0.995


def colours_and_exposures(exposures: ArrayLike = FOUR_EXPOSURES[0]) -> tuple[Array, Array]:
    """Return patterns (4, 4) of channels and transparencies: Bayer cells, alternately clear and dark.

    Each colour is behind each filter at the same number of pixels.
    """
    clear, dark = np.asarray(exposures, np.float64)
    cells = np.array([[clear, dark], [dark, clear]])
    return np.tile(BAYER, (2, 2)), np.kron(cells, np.ones((2, 2)))


def added_decades(e: ArrayLike) -> float:
    """Return log10(max e / min e), the decades that the mosaic adds to those of one pixel."""
    return float(np.log10(np.max(e) / np.min(e)))


def shoot(
    E: ArrayLike,
    e: ArrayLike,
    c: ArrayLike | None = None,
    *,
    full_well: float = np.inf,
    read_noise: float = 0.0,
    bits: int = 8,
    rng: int | np.random.Generator = 0,
) -> Array:
    """Take one photograph through the filters: X = e E_c with photon and read noise, in levels.

    Parameters
    ----------
    E : (H, W) or (H, W, 3) radiance, 1 fills a clear pixel
    e : (H, W) transparencies
    c : (H, W) channels of an RGB scene
    full_well, read_noise : electrons
    bits : 8 or 16
    rng : seed, or a generator, which is advanced

    Returns
    -------
    Z : (H, W) uint8 or uint16

    Raises
    ------
    ValueError
        For radiance, transparencies or channels that do not fit together.

    Examples
    --------
    >>> shoot(np.full((2, 2), 0.5), [[1, 0.5], [0.25, 0.125]])
    array([[128,  64],
           [ 32,  16]], dtype=uint8)
    """
    E = as_radiance(E)
    e = _transparency(e, E.shape[:2])
    if (c is None) != (E.ndim == 2) or bits not in (8, 16):
        raise InputError(
            f"expected channels for RGB alone, and 8 or 16 bits, got {describe(E)} and {bits}"
        )
    if not (full_well > 0 and 0 <= read_noise < np.inf):
        raise InputError(
            f"expected a positive well, noise of at least 0, got {full_well} and {read_noise}"
        )
    light = E if c is None else sample(E, c)
    X = np.minimum(e * light, 4.0)
    rng = np.random.default_rng(rng)
    if full_well < np.inf:
        N = np.minimum(rng.poisson(full_well * X), full_well) + rng.normal(0, read_noise, X.shape)
        X = N / full_well
    top = 2**bits - 1
    return np.floor(np.clip(X, 0, 1) * top + 0.5).astype(np.uint8 if bits == 8 else np.uint16)


def weight(Z: Array, e: F64, *, full_well: float = np.inf, read_noise: float = 0.0) -> F64:
    """Return w = 1 / var(Z / e); 0 for a full pixel.

    The variance is (X / well + (read / well)^2 + 1 / (12 top^2)) / e^2.
    """
    top = levels(Z) - 1
    X = Z / top
    noise = X / full_well + (read_noise / full_well) ** 2 + 1 / (12 * top**2)
    return np.where(X < CLIPPING_LEVEL, e**2 / noise, 0)


def normalised_convolution(values: F64, w: F64, sigma: float) -> tuple[F64, F64]:
    """Return (G w values) / (G w), and G w: normalised convolution."""
    total = gaussian_filter(w, sigma)
    return gaussian_filter(w * values, sigma) / np.maximum(total, 1e-300), total


def reconstruct(
    Z: ArrayLike,
    e: ArrayLike,
    c: ArrayLike | None = None,
    *,
    sigma: float = 0.5,
    full_well: float = np.inf,
    read_noise: float = 0.0,
) -> F64:
    """Reconstruct radiance from a photograph of assorted pixels.

    Parameters
    ----------
    Z : (H, W) uint8 or uint16, linear
    e : (H, W) transparencies
    c : (H, W) channels 0 to 2, or None for a gray sensor
    sigma : of G, pixels: small, so that it hardly blurs where many pixels measure; it reaches two
        pixels far
    full_well, read_noise : electrons, for the weights

    Returns
    -------
    E : (H, W) or (H, W, 3) float64; a lower bound where all pixels nearby are full

    Raises
    ------
    ValueError
        For levels, transparencies or channels that do not fit together.

    References
    ----------
    Nayar and Mitsunaga, High dynamic range imaging: spatially varying pixel exposures, CVPR 2000.
    Narasimhan and Nayar, Enhancing resolution along multiple imaging dimensions using assorted
    pixels, PAMI 2005.

    Examples
    --------
    >>> from hdrlab.core.filters.mosaic import tile
    >>> e = tile(FOUR_EXPOSURES, (8, 8))
    >>> E = reconstruct(shoot(np.full((8, 8), 20.0), e), e)
    >>> bool(np.abs(E / 20 - 1).max() < 0.02)
    True
    """
    Z = np.asarray(Z)
    if Z.ndim != 2 or Z.dtype not in (np.uint8, np.uint16) or Z.size == 0:
        raise InputError(f"expected levels (H, W) of uint8 or uint16, got {describe(Z)}")
    e = _transparency(e, Z.shape)
    w = weight(Z, e, full_well=full_well, read_noise=read_noise)
    values = Z / (levels(Z) - 1) / e
    if c is None:
        return _fill(values, w, e, sigma)
    masks = [as_channels(c, Z.shape) == k for k in range(3)]
    return np.stack([_fill(values, w * m, e, sigma, m) for m in masks], axis=-1)


def _fill(values: F64, w: F64, e: F64, sigma: float, mask: Array | bool = True) -> F64:
    """Return E^ from near pixels, or from farther ones, or else the bound 1 / min e."""
    E, total = normalised_convolution(values, w, sigma)
    for wider in (2 * sigma, 4 * sigma):
        unknown = total < 1e-6 * w.max() * (e.min() / e.max()) ** 2
        if not unknown.any() or not w.any():
            break
        more, more_total = normalised_convolution(values, w, wider)
        E = np.where(unknown, more, E)
        total = np.where(unknown, more_total, total)
    return np.where(total > 0, E, 1 / e[np.broadcast_to(mask, e.shape)].min())


def _transparency(e: ArrayLike, shape: tuple[int, ...]) -> F64:
    """Return transparencies as float64, or raise an InputError."""
    checked = np.asarray(e, np.float64)
    if checked.shape != shape or not np.all((checked > 0) & (checked <= 1)):
        raise InputError(
            f"expected transparencies {shape} above 0 and at most 1, got {describe(checked)}"
        )
    return checked
