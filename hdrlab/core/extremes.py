"""The darkest and the brightest luminance of a picture, but for a few pixels: a hot one must not set a scale.

L    luminance            (H, W) float32, >= 0
cut  fraction left out    of the lit pixels (L > 0), and at least one pixel
"""

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float32]

ENOUGH = 1 << 18  # pixels: a larger picture is ranked by every second, third, ... of its pixels


def lit(L: Float) -> Float:
    """Return the luminances above 0, as a list: log L exists there."""
    return L.ravel() if L.min() > 0 else L[L > 0]


def darkest(L: Float, *, cut: float = 1e-4) -> float:
    """Return the luminance that a fraction `cut` of the lit pixels lies below; 0 without light."""
    return _ranked(lit(L), cut, from_top=False)


def brightest(L: Float, *, cut: float = 1e-4) -> float:
    """Return the luminance that a fraction `cut` of the lit pixels lies above; 0 without light.

    Examples
    --------
    >>> L = np.append(np.linspace(1, 2, 999), 1e6).astype(np.float32)  # one hot pixel
    >>> round(brightest(L), 2)
    2.0
    """
    return _ranked(lit(L), cut, from_top=True)


def _ranked(values: Float, cut: float, *, from_top: bool) -> float:
    if not values.size:
        return 0.0
    values = values[:: -(-values.size // ENOUGH)]
    left_out = min(max(1, int(cut * values.size)), (values.size - 1) // 2)  # of a tiny picture, some stay
    rank = values.size - 1 - left_out if from_top else left_out
    return float(np.partition(values, rank)[rank])
