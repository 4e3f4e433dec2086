"""Ward's histogram adjustment with its curve read from a table, in bands of rows."""

import numpy as np

from hdrlab.core.arrays import F32, F64
from hdrlab.fast import _bands, _lookup, with_parts
from hdrlab.tonemap import ward

_KNOTS = 1 << 14  # of the curve, in all: a line from knot to knot is the exponential


def display(L: F32, lnL: F64, lnLd: F64, *, black: float, white: float) -> F32:
    """Return (Ld - Ldmin) / (Ldmax - Ldmin) of each pixel, read from the curve."""
    bins = len(lnL) - 1
    at = np.exp(np.linspace(lnL[0], lnL[-1], bins * max(1, _KNOTS // bins) + 1))
    table = _lookup.tabulate(ward.display(at, lnL, lnLd, black=black, white=white))
    scale, first = np.float32((len(table) - 1) / (lnL[-1] - lnL[0])), np.float32(lnL[0])

    def read(L: F32) -> F32:
        return _lookup.interpolate(table, (np.log(np.maximum(L, ward.TINY)) - first) * scale)

    return _bands.banded(read, L)


tonemap = with_parts(__name__, ward.tonemap, display=display)
