"""Ward's histogram adjustment with its curve read from a table, in bands of rows."""

import numpy as np
from numpy.typing import ArrayLike

from hdrlab.core.arrays import as_luminance
from hdrlab.core.types import F32
from hdrlab.fast import _lookup
from hdrlab.fast._bands import banded
from hdrlab.tonemap import ward

_KNOTS = 1 << 14  # of the curve, in all: a line from knot to knot is the exponential


def tonemap(
    L: ArrayLike,
    *,
    black: float = 1.0,
    white: float = 100.0,
    bins: int = 100,
    field: float = 60.0,
    tolerance: float = 0.025,
) -> F32:
    """Return display luminance by equalising the histogram of brightness, no contrast above the scene's."""
    L = as_luminance(L)
    b, lnLd = ward.curve(L, black=black, white=white, bins=bins, field=field, tolerance=tolerance)
    at = np.linspace(0, bins, bins * max(1, _KNOTS // bins) + 1)
    Ld = np.exp(np.interp(at, np.arange(bins + 1), lnLd))
    table = _lookup.tabulate(np.clip((Ld - black) / (white - black), 0, 1))
    scale = np.float32((len(table) - 1) / (b[-1] - b[0]))

    def display(L: F32) -> F32:
        b_L = np.log(np.maximum(L, np.float32(ward.TINY)))
        return _lookup.interpolate(table, (b_L - np.float32(b[0])) * scale)

    return banded(display, L)
