"""Linear interpolation on a curve with evenly spaced knots, many times as fast as np.interp.

knots  values at t = 0, 1, ..., n   (n + 1,); straight lines between them, constant beyond them
t      positions                    any shape, float32
"""

import numpy as np

from hdrlab.core.arrays import F32, ArrayLike, NDArray


def tabulate(knots: ArrayLike) -> NDArray[np.complex64]:
    """Return the knots with the rise to the next one as imaginary part.

    So one look-up gets both.
    """
    knots = np.asarray(knots, np.float64)
    rises = np.append(np.diff(knots), 0)
    return (knots + 1j * rises).astype(np.complex64)


def interpolate(table: NDArray[np.complex64], t: ArrayLike) -> F32:
    """Return the curve's value at each t, from the table of its knots by `tabulate`.

    Examples
    --------
    >>> interpolate(tabulate([0, 10, 40]), [-1, 0.5, 1.5, 7]).tolist()
    [0.0, 5.0, 25.0, 40.0]
    """
    t = np.clip(np.asarray(t, np.float32), 0, len(table) - 1)
    left = np.floor(t)
    line = table.take(left.astype(np.intp), mode="clip")
    return line.real + (t - left) * line.imag
