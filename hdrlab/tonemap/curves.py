"""Curves from scene to display: linear scaling, gamma, logarithm, and the quantisation after them.

L      luminance           (H, W) >= 0, any linear unit
low    Lw_min              the darkest luminance of the scene
high   Lw_max              the brightest
F      tone curve          [Lw_min, Lw_max] -> [0, 1]
Ld     display luminance   F(L), (H, W), 1 = white
N      levels of a display

A tone reproduction curve maps equal luminances to equal values everywhere in the picture. A tone
reproduction operator (TRO) also depends on the neighbourhood, so one luminance may become several
values; `spread` shows which of the two a result is. Ld is light, and is encoded for the display
afterwards (`core.colour.encode_srgb`). The levels Q of a display are codes, so by default F is
taken as a code. Taken as light, a gamma loses contrast and a logarithm looks pale.
"""

from collections.abc import Callable
from typing import Literal

import numpy as np

from hdrlab.core import extremes
from hdrlab.core.arrays import F32, Array, ArrayLike, as_luminance
from hdrlab.core.colour import decode_srgb
from hdrlab.errors import InputError

LAWS = ("monotone", "exposure")


def linear(L: F32, *, high: float) -> F32:
    """Return F(L) = L / Lw_max: black stays black, and most of a wide range falls below one level."""
    white = np.float32(high)
    return np.divide(np.minimum(L, white), white, dtype=np.float32)


def gamma(L: F32, *, high: float, gamma: float = 2.2) -> F32:
    """Return F(L) = (L / Lw_max)^(1 / gamma): every ratio of luminances is compressed alike."""
    return linear(L, high=high) ** np.float32(1 / gamma)


def logarithmic(L: F32, *, low: float, high: float) -> F32:
    """Return F(L) = log(L / Lw_min) / log(Lw_max / Lw_min): every stop takes the same share of the range."""
    if not low < high:
        return np.where(L < low, np.float32(0), np.float32(1))
    stops = np.log(np.clip(L, low, high)) - np.log(np.float32(low))
    return np.clip(stops / np.float32(np.log(high) - np.log(low)), 0, 1)


CURVES: dict[str, Callable[..., F32]] = {"linear": linear, "gamma": gamma, "log": logarithmic}


def quantise(Ld: ArrayLike, *, levels: int = 256) -> Array:
    """Return Q = floor((N - 1) Ld + 0.5), Ld in [0, 1], as uint8 or uint16 [Battiato08 eq. 1.21].

    Raises a ValueError if Ld leaves [0, 1] or `levels` does not fit 16 bits.
    """
    Ld = np.asarray(Ld)
    if not 2 <= levels <= 65536:
        raise InputError(f"expected 2 to 65536 levels, got {levels}")
    outside = np.count_nonzero(~((Ld >= 0) & (Ld <= 1)))
    if outside:
        raise InputError(f"expected values in [0, 1], got {outside} outside it in shape {Ld.shape}")
    return np.floor((levels - 1) * Ld + 0.5).astype(np.uint8 if levels <= 256 else np.uint16)


def spread(L: F32, Ld: F32, *, bins: int = 64) -> tuple[F32, F32, F32]:
    """Return (luminance, minimum Ld, maximum Ld) of `bins` classes of equally many pixels, dark to bright.

    For a curve, the maximum of one class is the minimum of the next, and both draw the curve. For
    an operator they draw a band, which is as wide as the influence of the neighbourhood.
    """
    order = np.argsort(L, axis=None, kind="stable")
    classes = np.array_split(order, min(bins, order.size))
    luminance = [L.flat[pixels[len(pixels) // 2]] for pixels in classes]
    lowest = [Ld.flat[pixels].min() for pixels in classes]
    highest = [Ld.flat[pixels].max() for pixels in classes]
    return (
        np.asarray(luminance, np.float32),
        np.asarray(lowest, np.float32),
        np.asarray(highest, np.float32),
    )


def tonemap(
    L: ArrayLike,
    *,
    curve: Literal["linear", "gamma", "log"] = "log",
    gamma: float = 2.2,
    cut: float = 1e-4,
    encoded: bool = True,
) -> F32:
    """Return display luminance by one tone curve for all pixels: linear, gamma or logarithmic.

    Parameters
    ----------
    L : (H, W) luminance, finite and not negative, any linear unit
    curve : name of the curve
    gamma : the gamma curve's exponent is 1 / gamma
    cut : fraction of the positive pixels to leave out at either end of the scene's range, and at
        least one pixel
    encoded : take F as the display's code, and return the light that it shows, so that F becomes
        the levels of the picture; False takes F itself as light, which looks pale when encoded

    Returns
    -------
    (H, W) float32 in [0, 1], 1 = white

    Raises
    ------
    ValueError
        For luminance that is not (H, W), finite and at least 0; an unknown curve; gamma or cut out
        of range.

    References
    ----------
    Battiato, Castorina, Messina, Exposure correction for imaging devices: an overview, 2008, eq.
    1.21.

    Examples
    --------
    >>> tonemap(np.array([[1.0, 10.0, 100.0, 1000.0, 10000.0]])).round(2)
    array([[0.  , 0.  , 0.21, 1.  , 1.  ]], dtype=float32)
    """
    L = as_luminance(L)
    if curve not in CURVES:
        raise InputError(f"expected one of the curves {', '.join(CURVES)}, got {curve!r}")
    if not (0 < gamma < np.inf and 0 <= cut < 0.5):
        raise InputError(
            f"expected gamma > 0 and a cut in [0, 0.5), got gamma={gamma} and cut={cut}"
        )
    low = extremes.robust_minimum(L, cut=cut) or 1.0
    high = extremes.robust_maximum(L, cut=cut) or 1.0
    if curve == "linear":
        F = CURVES["linear"](L, high=high)
    elif curve == "gamma":
        F = CURVES["gamma"](L, high=high, gamma=gamma)
    else:
        F = CURVES["log"](L, low=low, high=high)
    return np.asarray(decode_srgb(F), np.float32) if encoded else F
