"""Durand and Dorsey's operator, fast: the bilateral filter on its grid; bands where all is certain stay."""

from functools import partial

from hdrlab.core.arrays import F32
from hdrlab.fast import with_parts
from hdrlab.fast._bands import banded
from hdrlab.fast.bilateral import bilateral
from hdrlab.fast.blur import gaussian
from hdrlab.tonemap import durand

_fix = with_parts(__name__, durand.fix_uncertain, gaussian_filter=gaussian)


def fix_uncertain(mean: F32, k: F32, *, sigma_s: float) -> F32:
    """Return the lesson's base."""
    return banded(partial(_fix, sigma_s=sigma_s), mean, k, margin=4 * durand.NEAR)


def combine(base: F32, detail: F32) -> F32:
    """Return the lesson's 10^(base + detail)."""
    return banded(durand.combine, base, detail)


layers = with_parts(__name__, durand.layers, bilateral=bilateral, fix_uncertain=fix_uncertain)
tonemap = with_parts(__name__, durand.tonemap, layers=layers, combine=combine)
