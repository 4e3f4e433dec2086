"""Brightness transfer between two photographs, from their histograms (Grossberg and Nayar, PAMI 2003).

h   histogram                     (n,) counts of the levels of a photograph
H   cumulative histogram          (n + 1,), H[z] is the share of the pixels below level z
T   brightness transfer function  (n,), the level in B of what has level m in A; between levels where need be
n   number of levels              256 or 65536

Light is monotone in level, whatever the camera's response: the k-th darkest pixel of A is the k-th
darkest of B, so T = H_B^-1(H_A) [Grossberg03 sec. 3]. That needs no alignment, only that both show
the same light.

Levels are steps: level z holds the light from z - 1/2 to z + 1/2, and a rank lies somewhere on a
step. `brightness_transfer` takes the middle of A's step. `literal_transfer` takes a cumulated count
for that of its level, though the count belongs to the step's upper edge: so m + 1/2 is paired with
T(m) + 1/2.
"""

import numpy as np

from hdrlab.core.arrays import F64, Array, ArrayLike, as_mask, as_stack, describe, levels
from hdrlab.errors import InputError


def histograms(images: ArrayLike, valid: ArrayLike | None = None) -> Array:
    """Return h (C, P, n) of photographs (P, H, W[, C]), over the pixels that are valid in every frame."""
    stack = as_stack(images)
    mask = as_mask(valid, stack)
    pixels = stack.reshape(len(stack), -1, stack[0, 0, 0].size)
    if mask is not None:
        pixels = pixels[:, mask.all(axis=0).ravel()]
    n = levels(stack)
    channels = np.moveaxis(pixels, -1, 0)
    return np.array([[np.bincount(Z, minlength=n) for Z in frames] for frames in channels])


def cumulate(h: ArrayLike, n: int) -> F64:
    """Return H (n + 1,) from 0 to 1: shares of all pixels, so that photographs of two sizes compare."""
    h = np.asarray(h, np.float64)
    if h.shape != (n,) or not h.min() >= 0 or not h.any():
        raise InputError(f"expected a histogram ({n},) of counts, not all 0, got {describe(h)}")
    return np.concatenate([[0], np.cumsum(h) / h.sum()])


def brightness_transfer(h_A: ArrayLike, h_B: ArrayLike) -> F64:
    """Return T = H_B^-1(H_A) (n,), where the middle of A's step m lies between the edges of B's steps.

    T is NaN where it would be B's lowest or highest level: these have no outer edge, because they
    hold everything darker or brighter. It is NaN, too, for levels below or above all pixels of A,
    which have no rank.

    Examples
    --------
    >>> float(brightness_transfer([1, 2, 1, 0], [0, 1, 2, 1])[1])
    2.0
    """
    n = len(np.asarray(h_A))
    H_A = cumulate(h_A, n)
    H_B = cumulate(h_B, n)
    middle = (H_A[1:] + H_A[:-1]) / 2
    edges = np.arange(n + 1) - 0.5
    T = np.interp(middle, H_B, edges)
    return np.where((middle > 0) & (middle < 1) & (T > edges[1]) & (T <= edges[-2]), T, np.nan)


def literal_transfer(h_A: ArrayLike, h_B: ArrayLike) -> F64:
    """Return T(m), where H_B reaches H_A(m), on lines between B's levels."""
    n = len(np.asarray(h_A))
    H_A = cumulate(h_A, n)
    H_B = cumulate(h_B, n)
    occupied = np.flatnonzero(np.diff(H_B))
    return np.interp(H_A[1:], H_B[1:][occupied], occupied)
