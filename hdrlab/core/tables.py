"""Tables over the pixel levels: what keeps one smooth, and what makes it monotone."""

import numpy as np

from hdrlab.core.types import F64


def second_differences(w: F64, smoothness: float) -> F64:
    """Return the rows (n - 2, n) of lambda w(z) g''(z), which gsolve keeps small [Debevec97 eq. 3].

    Examples
    --------
    >>> second_differences(np.ones(4), 10) @ [0, 1, 2, 4]  # g'' is 0 on a line
    array([ 0., 10.])
    """
    return smoothness * w[1:-1, None] * np.diff(np.eye(len(w)), 2, axis=0)


def make_monotone(g: F64) -> F64:
    """Return g (n, ...) with every fall levelled, outward from the middle, which keeps its value.

    Examples
    --------
    >>> make_monotone(np.array([-1.0, -2.0, 0.0, 2.0, 1.0])).tolist()
    [-2.0, -2.0, 0.0, 2.0, 2.0]
    """
    m = len(g) // 2
    up, down = np.maximum.accumulate(g[m:], axis=0), np.minimum.accumulate(g[m::-1], axis=0)
    return np.concatenate([down[::-1], up[1:]])
