"""Brightness transfer: where a level of one photograph lies in another, read off their histograms.

h   histogram of a photograph     (n,) counts
H   the same, cumulated           H[z] pixels lie at level z or below
T   brightness transfer function  (n,), the level in B of what has level m in A, between levels where need be
n   number of levels              256 or 65536

Light is monotone in level, whatever the camera's response: the k-th darkest pixel of A is the k-th darkest
of B, so T = H_B^-1(H_A) [Grossberg03 sec. 3]. That needs no alignment, only that both show the same light.

Levels are steps, and the question is where on a step a rank lies. `literal` takes a cumulated count for that
of its level, though the count belongs to the step's upper edge: so m + 1/2 is paired with T(m) + 1/2.
`mid_step` asks for the middle of A's step and reads the answer between the edges of B's.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core.arrays import Array, describe

Float = NDArray[np.float64]
Transfer = Callable[[ArrayLike, ArrayLike], Float]


def histogram(Z: Array, n: int) -> NDArray[np.int64]:
    """Return h (n,), how many pixels have each level."""
    return np.bincount(Z.ravel(), minlength=n)


def literal(h_A: ArrayLike, h_B: ArrayLike) -> Float:
    """Return T(m), where H_B reaches H_A(m), on lines between B's levels."""
    H_A, H_B = _shares(h_A, h_B)
    occupied = np.diff(H_B, prepend=0) > 0
    return np.interp(H_A, H_B[occupied], np.flatnonzero(occupied))


def mid_step(h_A: ArrayLike, h_B: ArrayLike) -> Float:
    """Return T(m), where the middle of A's step m lies in B, whose step z reaches from z - 1/2 to z + 1/2.

    NaN where that is on B's lowest or highest step: these have no outer edge, as they hold all that is
    darker or brighter. NaN, too, for levels below or above all of A's pixels, which have no rank.

    Examples
    --------
    >>> float(mid_step([1, 2, 1, 0], [0, 1, 2, 1])[1])
    2.0
    """
    H_A, H_B = _shares(h_A, h_B)
    middle = H_A - np.diff(H_A, prepend=0) / 2
    z = np.searchsorted(H_B, middle).clip(max=len(H_B) - 1)  # the step on which that lies, never an empty one
    h, below = np.diff(H_B, prepend=0)[z], np.concatenate([[0], H_B])[z]
    with np.errstate(divide="ignore", invalid="ignore"):  # where z is 0 and without pixels
        T = z - 0.5 + (middle - below) / h
    return np.where((middle > 0) & (middle < 1) & (z > 0) & (z < len(H_B) - 1), T, np.nan)


def _shares(h_A: ArrayLike, h_B: ArrayLike) -> tuple[Float, Float]:
    """Return the cumulated histograms as shares of all pixels, so that photographs of two sizes compare."""
    h_A, h_B = np.asarray(h_A, np.float64), np.asarray(h_B, np.float64)
    if h_A.ndim != 1 or h_A.shape != h_B.shape or len(h_A) < 3 or min(h_A.min(), h_B.min()) < 0:
        raise ValueError(
            f"expected two histograms (n,) of as many levels, got {describe(h_A)} and {describe(h_B)}"
        )
    if not (h_A.any() and h_B.any()):
        raise ValueError("expected histograms that hold pixels, got one without any")
    return np.cumsum(h_A) / h_A.sum(), np.cumsum(h_B) / h_B.sum()
