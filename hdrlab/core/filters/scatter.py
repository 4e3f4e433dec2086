"""Veiling glare: light that a lens scatters from every point over the whole picture.

E      radiance                (H, W[, 3]) float32
r      distance                pixels
K      glare spread function   (H', W'), K(r) = 1 / (1 + (r / core)^2)^(power / 2), without its middle, sum 1
share  of the light that is scattered, 0 to 1

The sensor receives (1 - share) E + share (K * E). In a lens with dust, fingerprints and many surfaces
K falls off with a power of two to three [Talvala07 fig. 3]: so slowly that a bright window lifts the
darkest corner.
"""

import math
from typing import NamedTuple

import numpy as np
import scipy

from hdrlab.core.arrays import F32, Array
from hdrlab.errors import InputError


class GlareSpread(NamedTuple):
    """A glare spread function: share of the light, power of the fall, core in pixels."""

    share: float
    power: float = 2.5
    core: float = 1.0


def validate_spread(spread: GlareSpread) -> GlareSpread:
    """Return the spread, or raise a ValueError for numbers out of range."""
    share, power, core = spread
    if not (0 <= share < 1 and 0 < power < np.inf and 0 < core < np.inf):
        raise InputError(
            f"expected a fraction from 0 to below 1, a power and a core above 0, got {tuple(spread)}"
        )
    return spread


def spread_transform(shape: tuple[int, ...], power: float, core: float = 1.0) -> Array:
    """Return the Fourier transform of K over twice the frame, so that no light wraps around its edges.

    K is cut off at distances that no two pixels of the frame have, and its sum is 1 within them.
    """
    size = [scipy.fft.next_fast_len(2 * n, real=True) for n in shape[:2]]
    y, x = [np.minimum(np.arange(n), n - np.arange(n)).astype(np.float32) for n in size]
    K = (1 + (y[:, None] ** 2 + x**2) / np.float32(core**2)) ** np.float32(-power / 2)
    K[0, 0] = 0
    K[shape[0] : size[0] - shape[0] + 1] = 0
    K[:, shape[1] : size[1] - shape[1] + 1] = 0
    total = K.sum(dtype=np.float64).astype(np.float32)
    if total > 0:  # a frame of one pixel has no other
        K = K / total
    return np.asarray(scipy.fft.rfft2(K), np.complex64)


def scatter(E: F32, transform: Array) -> F32:
    """Return K * E, channel by channel, without the unknown light from outside the frame.

    Examples
    --------
    >>> E = np.zeros((5, 5), np.float32)
    >>> E[2, 2] = 100
    >>> glare = scatter(E, spread_transform(E.shape, 2.0))
    >>> float(glare[2, 2].round(3)), bool(glare[2, 3] > glare[2, 4] > 0)
    (0.0, True)
    """
    height, width = E.shape[:2]
    size = (transform.shape[0], scipy.fft.next_fast_len(2 * width, real=True))
    planes = E.reshape(height, width, -1)
    # a power of 2, so that division is exact; sums of the quotients stay within float32
    _, exponent = math.frexp(float(E.max()))
    unit = np.float32(math.ldexp(1, exponent - 1))
    out = np.empty_like(planes)
    for c in range(planes.shape[-1]):
        spectrum = scipy.fft.rfft2(planes[..., c] / unit, size)
        spectrum *= transform
        out[..., c] = scipy.fft.irfft2(spectrum, size)[:height, :width]
    return (np.maximum(out, 0) * unit).reshape(E.shape)
