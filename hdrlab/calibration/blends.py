"""Blends of two lights, and the curve that joins them (Wilburn, Xu and Matsushita, CVPR 2008, sec. 2).

While the shutter is open, a pixel receives one of two lights, L_0 for a fraction alpha of the time,
and L_1 for the rest. So it integrates I = alpha I_0 + (1 - alpha) I_1 [eq. 4]: an exposure that is
known except for a scale and an offset.

I  relative irradiance   (l,), any unit, any zero: alpha, or 0, 1, 2 ... along a ramp, or exposure time
M  brightness            (l,), 0 to 1: pixel level over the highest one
s  scales, r  offsets    (n,), of n blends: s_j I_ij + r_j all lie on one curve
g  inverse response      M -> X, a table over 1024 brightnesses of the measured range
X  exposure              0 at the lowest brightness measured, 1 at the highest [Wilburn08 sec. 5]
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F64, ArrayLike, describe
from hdrlab.errors import InputError

# the paper's typical range of brightnesses that are measurements
MIN_BRIGHTNESS = 15 / 255
MAX_BRIGHTNESS = 240 / 255
# entries of a table; between two of them, a response is straight to a millionth
TABLE_SIZE = 1024
GRID = np.linspace(0, 1, TABLE_SIZE)


class Blend(NamedTuple):
    """Relative irradiances I (l,) and the brightnesses M (l,) that they were measured as."""

    I: F64  # noqa: E741, the paper's letter
    M: F64


class InverseResponse(NamedTuple):
    """The inverse response X (1024,) at the brightnesses M (1024,), and the blends' s and r (n,)."""

    M: F64
    X: F64
    s: F64
    r: F64


def make_blend(
    irradiance: ArrayLike,
    brightness: ArrayLike,
    *,
    low: float = MIN_BRIGHTNESS,
    high: float = MAX_BRIGHTNESS,
) -> Blend:
    """Return a Blend of the samples whose brightness lies between `low` and `high`.

    Raises
    ------
    ValueError
        For arrays (l,) that do not fit together or are not finite.
    """
    x = np.asarray(irradiance, np.float64)
    M = np.asarray(brightness, np.float64)
    if x.shape != M.shape or x.ndim != 1 or not np.all(np.isfinite([x, M])):
        raise InputError(
            f"expected finite irradiance and brightness (l,), got {describe(x)}, {describe(M)}"
        )
    if not 0 <= low < high <= 1:
        raise InputError(f"expected a range of brightness within 0 to 1, got {low} to {high}")
    inside = (low <= M) & (M <= high)
    return Blend(x[inside], M[inside])


def select_blends(blends: Sequence[Blend], *, min_samples: int = 3) -> list[Blend]:
    """Return the blends that constrain the curve, or raise a ValueError if there is none.

    A blend has two unknowns of its own, s and r, which use up its first two samples. So blends with
    fewer than `min_samples` are left out.
    """
    blends = [make_blend(blend.I, blend.M, low=0, high=1) for blend in blends]
    usable = [b for b in blends if len(b.M) >= min_samples and np.ptp(b.I) > 0 and np.ptp(b.M) > 0]
    if not usable:
        sizes = ", ".join(str(len(blend.M)) for blend in blends)
        raise InputError(
            f"expected a blend with {min_samples} different brightnesses, got {sizes or 'none'}"
        )
    return usable


def brightness_range(blends: Sequence[Blend]) -> tuple[float, float]:
    """Return the lowest and the highest brightness measured."""
    M = np.concatenate([blend.M for blend in blends])
    return float(M.min()), float(M.max())


def rescale(blends: Sequence[Blend]) -> list[Blend]:
    """Return the blends with brightness m = 0 to 1 over the measured range."""
    low, high = brightness_range(blends)
    return [Blend(blend.I, (blend.M - low) / (high - low)) for blend in blends]


def normalize(M: F64, X: F64, s: F64, r: F64) -> InverseResponse:
    """Return the curve with X from 0 to 1, s and r in the same unit: (X - X_0) / (X_end - X_0)."""
    zero = X[0]
    span = X[-1] - X[0]
    return InverseResponse(M, (X - zero) / span, s / span, (r - zero) / span)


def build_response(
    blends: Sequence[Blend], g: F64, s: F64, r: F64, *, ends: float
) -> InverseResponse:
    """Return g, a table over the measured range, without a fraction `ends` of the samples at either end.

    The lowest and the highest measured brightness are extreme because of their noise, and no curve
    through such samples is right. So the samples are ordered by s_j I_ij + r_j, and not by their
    brightness.

    Raises
    ------
    ValueError
        For a fraction that is not in 0 to 0.25.
    """
    if not 0 <= ends < 0.25:
        raise InputError(f"expected ends from 0 to 0.25, got {ends}")
    darkest, brightest = brightness_range(blends)
    M = np.linspace(darkest, brightest, len(g))
    X = np.concatenate([s_j * blend.I + r_j for blend, s_j, r_j in zip(blends, s, r, strict=True)])
    low, high = np.quantile(np.interp(X, g, M), [ends, 1 - ends])
    inner = np.linspace(low, high, TABLE_SIZE)
    return normalize(inner, np.interp(inner, M, g), s, r)


def difference(found: InverseResponse, truth: InverseResponse, *, fit: bool = False) -> F64:
    """Return found - truth (1024,) over the common range of brightness, where the truth goes from 0 to 1.

    Scale and offset are ambiguous [Wilburn08 sec. 2.1]. So both curves are scaled to 0 ... 1 [sec.
    5]. With `fit`, `found` gets the scale and offset that fit best, which separates errors of the
    shape from errors at the two ends.

    Raises
    ------
    ValueError
        Where the two have no range of brightness in common.
    """
    low = max(found.M[0], truth.M[0])
    high = min(found.M[-1], truth.M[-1])
    if not low < high:
        raise InputError(
            f"expected curves that overlap, got M of {found.M[[0, -1]]} and {truth.M[[0, -1]]}"
        )
    M = np.linspace(low, high, TABLE_SIZE)
    X = np.interp(M, found.M, found.X)
    Y = np.interp(M, truth.M, truth.X)
    X = (X - X[0]) / (X[-1] - X[0])
    Y = (Y - Y[0]) / (Y[-1] - Y[0])
    return np.polyval(np.polyfit(X, Y, 1), X) - Y if fit else X - Y


def rmse(found: InverseResponse, truth: InverseResponse) -> float:
    """Return the root mean square of `difference`, the paper's RMSE (its maximum is the disparity)."""
    return float(np.sqrt(np.mean(difference(found, truth) ** 2)))


def ln_exposure(joined: InverseResponse, *, black: float = 0.0, n: int = 256) -> F64:
    """Return the response g = ln f^-1 (n,), g[n // 2] = 0, as every merge expects it.

    Parameters
    ----------
    joined : InverseResponse
        What a join found.
    black : float
        The X without any light, below the X of the lowest measured level. Blends do not constrain
        it, as their offset is ambiguous [Wilburn08 sec. 2.1]. If their darker light is nearly
        black, it is their offset, `joined.r.min()`.
    n : int
        Number of levels. Below the measured range, the curve is a straight line to (0, `black`);
        above it, it continues with its last slope. Level 0 gets the value at a quarter of a level,
        as ln 0 is not finite.

    Raises
    ------
    ValueError
        Where `black` is no less than the X of the lowest level measured.

    Examples
    --------
    >>> M = np.linspace(0.1, 0.9, 1024)
    >>> line = InverseResponse(M, (M - 0.1) / 0.8, np.ones(1), np.zeros(1))
    >>> g = ln_exposure(line, black=-0.125)
    >>> round(float(np.exp(g[64])), 3), g[128] == 0
    (0.5, np.True_)
    """
    if not black < joined.X[0]:
        raise InputError(
            f"expected a black level below {joined.X[0]}, the smallest measured X, got {black}"
        )
    M = joined.M
    X = joined.X - black
    slope = max((X[-1] - X[-9]) / (M[-1] - M[-9]), 0)
    levels = np.arange(n) / (n - 1)
    levels[0] = 0.25 / (n - 1)
    white = X[-1] + slope * (1 - M[-1])
    table = np.interp(levels, np.r_[0, M, 1], np.r_[0, X, white])
    g = np.log(np.maximum(table, 1e-12))
    return g - g[n // 2]
