"""Curves from scene to display, fast: computed in bands of rows."""

from collections.abc import Callable
from functools import partial

from hdrlab.core.arrays import F32
from hdrlab.core.colour import decode_srgb
from hdrlab.fast import _bands, with_parts
from hdrlab.tonemap import curves


def _in_bands(curve: Callable[..., F32]) -> Callable[..., F32]:
    def banded_curve(L: F32, **parameters: float) -> F32:
        return _bands.banded(partial(curve, **parameters), L)

    return banded_curve


tonemap = with_parts(
    __name__,
    curves.tonemap,
    CURVES={name: _in_bands(curve) for name, curve in curves.CURVES.items()},
    decode_srgb=partial(_bands.banded, decode_srgb),
)
