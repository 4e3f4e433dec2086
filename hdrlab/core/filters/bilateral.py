"""The bilateral filter, by its definition (Tomasi and Manduchi, ICCV 1998).

v        signal                (H, W), such as log luminance; nothing beyond its edge has weight
g        closeness in space    of pixels p and q, exp(-|p - q|^2 / (2 sigma_s^2)), sigma_s in pixels
w        closeness in range    exp(-(v_q - v_p)^2 / (2 sigma_r^2)), sigma_r in the unit of v
k        sum of all weights    (H, W), sum of g w: how many pixels a mean rests on, 1 to 2 pi sigma_s^2
"""

from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F32, ArrayLike, describe
from hdrlab.errors import InputError

# Beyond the edge the signal has this value, which differs too much from any pixel to have weight.
BORDER_VALUE = 1e9


class Filtered(NamedTuple):
    """The filtered signal, `mean` (H, W), and the sum of weights that each mean rests on, `k` (H, W)."""

    mean: F32
    k: F32


def bilateral(v: ArrayLike, *, sigma_s: float, sigma_r: float) -> Filtered:
    """Return mean = 1/k sum_q g w v_q, k = sum_q g w, over a square of 3 sigma_s [Battiato08 eq. 1.31].

    sigma_s is in pixels, sigma_r in the unit of v. Both must be positive, and v finite: anything
    else is a ValueError.

    Examples
    --------
    >>> step = np.where(np.arange(40) < 20, 0, 3) * np.ones((30, 1))
    >>> bool(np.allclose(bilateral(step, sigma_s=8, sigma_r=0.4).mean, step, atol=1e-3))
    True
    """
    v = np.asarray(v, np.float32)
    require_signal(v, sigma_s=sigma_s, sigma_r=sigma_r)
    H, W = v.shape
    r = min(int(np.ceil(3 * sigma_s)), max(v.shape))
    padded = np.pad(v, r, constant_values=BORDER_VALUE)
    total = np.zeros_like(v)
    k = np.zeros_like(v)
    for dy in range(-r, r + 1):
        for dx in range(-r, r + 1):
            q = padded[r + dy : r + dy + H, r + dx : r + dx + W]
            gw = np.exp(-(dx**2 + dy**2) / (2 * sigma_s**2) - (q - v) ** 2 / (2 * sigma_r**2))
            total += gw * q
            k += gw
    return Filtered(total / k, k)


def require_signal(v: F32, *, sigma_s: float, sigma_r: float) -> None:
    """Raise a ValueError unless v is (H, W) and finite, and the sigmas are positive."""
    if v.ndim != 2 or not v.size or not np.isfinite(v).all():
        raise InputError(f"expected a finite signal (H, W), got {describe(v)}")
    if not (0 < sigma_s < np.inf and 0 < sigma_r < np.inf):
        raise InputError(f"expected positive, finite sigmas, got {sigma_s=}, {sigma_r=}")
