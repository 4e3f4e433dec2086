"""Durand and Dorsey's operator, fast: the bilateral filter on a grid, and bands of rows.

A band without uncertain pixels is left as it is.
"""

from functools import partial

from hdrlab.core.arrays import F32
from hdrlab.fast import _bands, blur, with_parts
from hdrlab.fast.bilateral import bilateral
from hdrlab.tonemap import durand

_fix = with_parts(__name__, durand.fix_uncertain, gaussian_filter=blur.gaussian)


def fix_uncertain(mean: F32, k: F32, *, sigma_s: float) -> F32:
    """Return the lesson's base, computed in bands of rows."""
    return _bands.banded(partial(_fix, sigma_s=sigma_s), mean, k, margin=4 * durand.UNCERTAIN_SIGMA)


def combine(base: F32, detail: F32) -> F32:
    """Return the lesson's 10^(base + detail), computed in bands of rows."""
    return _bands.banded(durand.combine, base, detail)


layers = with_parts(__name__, durand.layers, bilateral=bilateral, fix_uncertain=fix_uncertain)
tonemap = with_parts(__name__, durand.tonemap, layers=layers, combine=combine)
