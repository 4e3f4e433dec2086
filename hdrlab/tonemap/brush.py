"""Local histogram equalisation: the Detail Brush (Mitsunaga and Nayar, CVPR 1999, sec. 7).

L    luminance                (H, W) >= 0, any linear unit
b    ln L                     `bins` between the darkest and the brightest of the window
f    histogram                (bins,), shares of the window's pixels, sum 1
P    cumulative distribution  at the edges of the bins, (bins + 1,), 0 to 1
Ld   display luminance        decode(P(ln L)), in [0, 1]: P is the code of the display, every code for as many

A window's histogram knows nothing of the rest of the scene, so detail shows in a window that no picture of
the whole has room for. The histogram is clipped, as in adaptive equalisation (Zuiderveld, Graphics Gems IV,
1994): no bin counts more than `limit` times an even share, and what is cut off fills the others. So a limit
of 1 is the plain logarithm; without one the equalisation is full, and shows the noise of flat walls.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core import lookup
from hdrlab.core.arrays import as_luminance
from hdrlab.core.bands import banded
from hdrlab.core.colour import decode_srgb
from hdrlab.core.extremes import robust_maximum, robust_minimum

Float = NDArray[np.float32]
Histogram = NDArray[np.float64]

LAWS = ("monotone", "exposure")
LEAST = 2.0  # ratio of luminances that the bins span at least: what is flatter is not stretched further
BAND = 32  # rows at a time, which stay in the processor's cache
TINY = np.float32(np.finfo(np.float32).tiny)


def span(L: Float) -> tuple[float, float]:
    """Return the darkest and the brightest of the window but for 0.01 %, at least a stop apart."""
    low, high = robust_minimum(L) or 1.0, robust_maximum(L) or 1.0
    widen = max(1.0, LEAST * low / high) ** 0.5
    return low / widen, high * widen


def histogram(b: Float, *, low: float, high: float, bins: int = 1024) -> Histogram:
    """Return f of ln L between ln low and ln high; what lies beyond counts in the bin at that end.

    A pixel counts in the two bins whose centres it lies between, so that none jumps from one to the next.
    """
    f = np.zeros(bins)
    for top in range(0, len(b), BAND):
        t = np.clip(place(b[top : top + BAND], low, high, bins) - np.float32(0.5), 0, bins - 1).ravel()
        left = np.floor(t)
        index, right = left.astype(np.intp), t - left
        shared = np.bincount(index, right, bins)
        f += np.bincount(index, minlength=bins) - shared + np.append(0, shared[:-1])
    return f / b.size


def place(b: Float, low: float, high: float, bins: int) -> Float:
    """Return where ln L lies among the edges of the bins, 0 to `bins`."""
    return (b - np.float32(np.log(low))) * np.float32(bins / np.log(high / low))


def clipped(f: Histogram, *, limit: float = 4.0) -> Histogram:
    """Return f cut at limit / bins, and what was cut off given to all bins as they have room below that."""
    top = min(limit / len(f), 1.0)
    f = np.minimum(f, top)
    room = top - f
    return f + room * ((1 - f.sum()) / max(room.sum(), 1e-12))


def cumulative(f: Histogram) -> Histogram:
    """Return P at the edges of the bins."""
    return np.minimum(np.concatenate([[0], np.cumsum(f)]), 1)


def equalise(L: Float, *, bins: int = 1024, limit: float = 4.0) -> Float:
    """Return Ld = decode(P(ln L)) for a window, or for a whole picture."""
    low, high = span(L)
    b = banded(lambda L: np.log(np.maximum(L, TINY)), L)
    P = cumulative(clipped(histogram(b, low=low, high=high, bins=bins), limit=limit))
    lines = lookup.lines(decode_srgb(P))
    return banded(lambda b: lookup.along(lines, place(b, low, high, bins)), b)


def under(shape: tuple[int, ...], centre: tuple[float, float], side: int) -> tuple[slice, slice]:
    """Return rows and columns of a square window around `centre` (y, x), moved to lie in the picture."""
    corners = (
        int(np.clip(round(c - side / 2), 0, max(0, n - side))) for c, n in zip(centre, shape, strict=True)
    )
    rows, columns = (slice(c, min(c + side, n)) for c, n in zip(corners, shape, strict=True))
    return rows, columns


def lens(
    L: ArrayLike,
    centre: tuple[float, float],
    *,
    size: int = 256,
    magnification: int = 1,
    bins: int = 1024,
    limit: float = 4.0,
) -> Float:
    """Return the picture in the brush: the window under it, equalised by itself and enlarged.

    Parameters
    ----------
    L : (H, W) luminance, finite and not negative, any linear unit
    centre : (y, x) of the brush, pixels of L; at the edge the window stays inside the picture
    size : side of the brush, pixels of the display
    magnification : pixels of the display per pixel of L, along each side
    bins, limit : as for `tonemap`

    Returns
    -------
    (size, size) float32 in [0, 1], display luminance; smaller where L is

    Raises
    ------
    ValueError
        For a window that is no luminance, and knobs out of range.

    References
    ----------
    Mitsunaga and Nayar, Radiometric self calibration, CVPR 1999.

    Examples
    --------
    >>> L = np.geomspace(1, 1e6, 100)[None] * np.ones((100, 1))
    >>> lens(L, (50, 20), size=40, magnification=2).shape
    (40, 40)
    """
    _check(bins, limit)
    if not (1 <= magnification <= size):
        raise ValueError(f"expected 1 <= magnification <= size, got {magnification=} and {size=}")
    L = np.asarray(L)
    rows, columns = under(L.shape[:2], centre, -(-size // magnification))
    Ld = equalise(as_luminance(L[rows, columns]), bins=bins, limit=limit)
    return Ld.repeat(magnification, axis=0).repeat(magnification, axis=1)[:size, :size]


def tonemap(L: ArrayLike, *, bins: int = 1024, limit: float = 4.0) -> Float:
    """Return display luminance of the whole picture as one window: what the brush is compared with.

    Parameters
    ----------
    L : (H, W) luminance, finite and not negative, any linear unit
    bins : of the histogram of ln L
    limit : how many times an even share a bin may count; 1 is the logarithm, inf full equalisation

    Returns
    -------
    (H, W) float32 in [0, 1], 1 = white

    Raises
    ------
    ValueError
        For luminance that is not (H, W), finite and positive or zero, and knobs out of range.

    References
    ----------
    Mitsunaga and Nayar, Radiometric self calibration, CVPR 1999.

    Examples
    --------
    >>> tonemap(np.array([[1.0, 10.0, 100.0, 1000.0, 10000.0]]), limit=1).round(2)
    array([[0.  , 0.  , 0.21, 1.  , 1.  ]], dtype=float32)
    """
    _check(bins, limit)
    return equalise(as_luminance(L), bins=bins, limit=limit)


def _check(bins: int, limit: float) -> None:
    if not (bins >= 1 and limit >= 1):
        raise ValueError(f"expected at least 1 bin and a limit of at least 1, got {bins=} and {limit=}")
