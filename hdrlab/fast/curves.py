"""Curves from scene to display, fast: a band of rows at a time."""

from collections.abc import Callable
from functools import partial

from hdrlab.core.arrays import F32
from hdrlab.core.colour import decode_srgb
from hdrlab.fast import _bands, with_parts
from hdrlab.tonemap import curves


def _of(curve: Callable[..., F32]) -> Callable[..., F32]:
    return lambda L, **ends: _bands.banded(partial(curve, **ends), L)


_parts = {"CURVES": {name: _of(curve) for name, curve in curves.CURVES.items()}}
tonemap = with_parts(
    __name__, curves.tonemap, **_parts, decode_srgb=partial(_bands.banded, decode_srgb)
)
