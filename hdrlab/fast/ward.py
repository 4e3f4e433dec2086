"""Ward's histogram adjustment with its curve read from a table, in bands of rows."""

import numpy as np

from hdrlab.core.arrays import F32, F64
from hdrlab.fast import _bands, _lookup, with_parts
from hdrlab.tonemap import ward

# enough for a straight line from knot to knot to equal the exponential
_KNOT_COUNT = 2**14


def display(L: F32, lnL: F64, lnLd: F64, *, black: float, white: float) -> F32:
    """Return (Ld - Ldmin) / (Ldmax - Ldmin) of each pixel, interpolated on the curve."""
    bins = len(lnL) - 1
    knots = np.exp(np.linspace(lnL[0], lnL[-1], bins * max(1, _KNOT_COUNT // bins) + 1))
    table = _lookup.tabulate(ward.display(knots, lnL, lnLd, black=black, white=white))
    knots_per_nat = np.float32((len(table) - 1) / (lnL[-1] - lnL[0]))
    first = np.float32(lnL[0])

    def read(L: F32) -> F32:
        lnL = np.log(np.maximum(L, ward.SMALLEST_FLOAT32))
        return _lookup.interpolate(table, (lnL - first) * knots_per_nat)

    return _bands.banded(read, L)


tonemap = with_parts(__name__, ward.tonemap, display=display)
