"""Blends of two lights, and the curve that joins them (Wilburn, Xu and Matsushita, CVPR 2008, sec. 2).

While the shutter is open a pixel sees one of two lights, L_0 for a share alpha of the time, L_1 for the rest.
So it gathers I = alpha I_0 + (1 - alpha) I_1 [eq. 4]: an exposure that is known but for a scale and an
offset.

I  relative irradiance   (l,), any unit, any zero: alpha, or 0, 1, 2 ... along a ramp, or exposure time
M  brightness            (l,), 0 to 1: pixel level over the highest one
s  scales, r  offsets    (n,), of n blends: s_j I_ij + r_j all lie on one curve
g  inverse response      M -> X, a table over 1024 brightnesses of the measured range
X  exposure              0 at the lowest brightness measured, 1 at the highest [Wilburn08 sec. 5]
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core.arrays import describe

Float = NDArray[np.float64]
LOW, HIGH = 15 / 255, 240 / 255  # the paper's typical range of brightnesses that are measurements
POINTS = 1024  # of a table: between two of them a response is straight to a millionth


class Blend(NamedTuple):
    """Relative irradiances I (l,) and the brightnesses M (l,) that they were measured as."""

    I: Float  # noqa: E741, the paper's letter
    M: Float


class Joined(NamedTuple):
    """The inverse response X (1024,) at the brightnesses M (1024,), and the blends' s and r (n,)."""

    M: Float
    X: Float
    s: Float
    r: Float


def blend(irradiance: ArrayLike, brightness: ArrayLike, *, low: float = LOW, high: float = HIGH) -> Blend:
    """Return a Blend of the samples whose brightness lies between `low` and `high`.

    Raises
    ------
    ValueError
        For arrays (l,) that do not fit together or are not finite.
    """
    x, M = np.asarray(irradiance, np.float64), np.asarray(brightness, np.float64)
    if x.shape != M.shape or x.ndim != 1 or not (np.all(np.isfinite(x)) and np.all(np.isfinite(M))):
        raise ValueError(
            f"expected irradiances and brightnesses (l,), finite, got {describe(x)} and {describe(M)}"
        )
    if not 0 <= low < high <= 1:
        raise ValueError(f"expected a range of brightness within 0 to 1, got {low} to {high}")
    inside = (low <= M) & (M <= high)
    return Blend(x[inside], M[inside])


def as_blends(blends: Sequence[Blend], *, fewest: int = 3) -> list[Blend]:
    """Return the blends that can say something of a curve, or raise a ValueError.

    A blend has two unknowns of its own, so its first two samples say nothing: those with fewer than `fewest`
    are left out.
    """
    checked = [blend(one.I, one.M, low=0, high=1) for one in blends]
    told = [one for one in checked if len(one.M) >= fewest and np.ptp(one.I) > 0 and np.ptp(one.M) > 0]
    if not told:
        sizes = ", ".join(str(len(one.M)) for one in checked)
        raise ValueError(
            f"expected a blend with {fewest} samples of different brightness, got blends of {sizes or 'none'}"
        )
    return told


def domain(blends: Sequence[Blend]) -> tuple[float, float]:
    """Return the lowest and the highest brightness measured."""
    M = np.concatenate([one.M for one in blends])
    return float(M.min()), float(M.max())


def unit(M: Float, X: Float, s: Float, r: Float) -> Joined:
    """Return the curve with X from 0 to 1, scales and offsets in the same unit: (X - X_0) / (X_end - X_0)."""
    zero, span = X[0], X[-1] - X[0]
    return Joined(M, (X - zero) / span, s / span, (r - zero) / span)


def within(joined: Joined, blends: Sequence[Blend], ends: float) -> Joined:
    """Return the curve where its blends lie, less the part `ends` of the samples at either end.

    The lowest and highest brightness measured are those that noise has taken there, and no curve through such
    samples is right. So a sample's place is where its irradiance puts it, s_j I_ij + r_j.

    Raises
    ------
    ValueError
        For a part that is none.
    """
    if not 0 <= ends < 0.25:
        raise ValueError(f"expected ends from 0 to 0.25, got {ends}")
    X = np.concatenate([s * one.I + r for one, s, r in zip(blends, joined.s, joined.r, strict=True)])
    low, high = np.quantile(np.interp(X, joined.X, joined.M), [ends, 1 - ends])
    at = np.linspace(low, high, POINTS)
    return unit(at, np.interp(at, joined.M, joined.X), joined.s, joined.r)


def difference(found: Joined, truth: Joined, *, fit: bool = False) -> Float:
    """Return found - truth (1024,) over the brightnesses that both measured; the truth goes from 0 to 1.

    Scale and offset are ambiguous [Wilburn08 sec. 2.1]: both curves go from 0 to 1 [sec. 5], or, with `fit`,
    those of `found` are the ones that fit best, which tells errors of shape from those of the two ends.

    Raises
    ------
    ValueError
        Where the two have no range of brightness in common.
    """
    low, high = max(found.M[0], truth.M[0]), min(found.M[-1], truth.M[-1])
    if not low < high:
        raise ValueError(
            f"expected curves that overlap in brightness, got {found.M[[0, -1]]}, {truth.M[[0, -1]]}"
        )
    M = np.linspace(low, high, POINTS)
    X, Y = (np.interp(M, one.M, one.X) for one in (found, truth))
    X, Y = (X - X[0]) / (X[-1] - X[0]), (Y - Y[0]) / (Y[-1] - Y[0])
    return np.polyval(np.polyfit(X, Y, 1), X) - Y if fit else X - Y


def rmse(found: Joined, truth: Joined) -> float:
    """Return the root of the mean squared `difference`: the paper's RMSE; its largest is the disparity."""
    return float(np.sqrt(np.mean(difference(found, truth) ** 2)))


def ln_exposure(joined: Joined, *, black: float = 0.0, n: int = 256) -> Float:
    """Return g = ln f^-1 (n,), g[n // 2] = 0: the chapter's table, for every merge.

    Parameters
    ----------
    joined : Joined
        What a join found.
    black : float
        The X that no light at all would have, below the X of the lowest level measured. Blends cannot tell
        it, their offset is ambiguous [Wilburn08 sec. 2.1]; where their darker light is nearly none, it is
        their offset, `joined.r.min()`.
    n : int
        Levels of the table. Below the measured range the curve runs straight to (0, `black`), above it goes
        on with its last slope; level 0 gets the middle of its cell, for ln 0 has no number.

    Raises
    ------
    ValueError
        Where `black` is no less than the X of the lowest level measured.

    Examples
    --------
    >>> M = np.linspace(0.1, 0.9, 1024)
    >>> line = Joined(M, (M - 0.1) / 0.8, np.ones(1), np.zeros(1))
    >>> g = ln_exposure(line, black=-0.125)
    >>> round(float(np.exp(g[64])), 3), g[128] == 0
    (0.5, np.True_)
    """
    if not black < joined.X[0]:
        raise ValueError(f"expected a black below {joined.X[0]}, the darkest X measured, got {black}")
    M, X = joined.M, joined.X - black
    slope = max((X[-1] - X[-9]) / (M[-1] - M[-9]), 0)
    at = np.arange(n) / (n - 1)
    at[0] = 0.25 / (n - 1)
    ends = ([0.0], [1.0]) if M[0] > 0 else ([], [1.0])
    table = np.interp(
        at, np.r_[ends[0], M, ends[1]], np.r_[[0.0] * len(ends[0]), X, X[-1] + slope * (1 - M[-1])]
    )
    g = np.log(np.maximum(table, 1e-12))
    return g - g[n // 2]
