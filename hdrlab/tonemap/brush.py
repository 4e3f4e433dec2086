"""Local histogram equalization: the Detail Brush (Mitsunaga and Nayar, CVPR 1999, sec. 7).

L    luminance                (H, W) >= 0, any linear unit
b    ln L                     `bins` bins between the darkest and the brightest luminance of the window
h    histogram                (bins,), fractions of the window's pixels, sum 1
P    cumulative distribution  at the edges of the bins, (bins + 1,), 0 to 1
Ld   display luminance        decode(P(ln L)), in [0, 1]: P is the code, and all codes are equally frequent

The histogram of a window does not depend on the rest of the scene. So the window shows detail that
a picture of the whole scene has no range for. The paper equalizes completely. Here the histogram is
clipped first, as in adaptive equalization (Zuiderveld, Graphics Gems IV, 1994): no bin counts more
than `limit` times the mean, and the excess is distributed over the other bins. A limit of 1 is the
plain logarithm. Without a limit, the equalization is complete, and shows the noise of flat walls.
"""

import math

import numpy as np

from hdrlab.core import colour, extremes
from hdrlab.core.arrays import F32, F64, ArrayLike, as_luminance
from hdrlab.errors import InputError

LAWS = ("monotone", "exposure")
# smallest ratio of luminances that the bins span, so that a flat window is not stretched
MIN_LUMINANCE_RATIO = 2.0
SMALLEST_FLOAT32 = np.finfo(np.float32).tiny


def find_range(L: F32) -> tuple[float, float]:
    """Return the lowest and highest luminance except for 0.01 % of the pixels, at least a stop apart."""
    low = extremes.robust_minimum(L) or 1.0
    high = extremes.robust_maximum(L) or 1.0
    widening = max(1.0, MIN_LUMINANCE_RATIO * low / high) ** 0.5
    return low / widening, high * widening


def bin_position(L: F32, low: float, high: float, bins: int) -> F32:
    """Return the position of ln L among the edges of the bins: 0 at ln low, `bins` at ln high."""
    b = np.log(np.maximum(L, SMALLEST_FLOAT32))
    return (b - np.float32(np.log(low))) * np.float32(bins / np.log(high / low))


def histogram(t: F32, bins: int = 1024) -> F64:
    """Return h, the fractions of the pixels in each bin, from their positions t.

    Positions beyond either end count in the bin at that end. A pixel is shared between the two bins
    whose centres it lies between, in proportion to its distances, so that no count jumps.
    """
    t = np.clip(t - np.float32(0.5), 0, bins - 1).ravel()
    left = t.astype(np.intp)
    right_counts = np.bincount(left, t - left, bins)
    left_counts = np.bincount(left, minlength=bins) - right_counts
    return (left_counts + np.append(0, right_counts[:-1])) / t.size


def clip_histogram(h: F64, *, limit: float = 4.0) -> F64:
    """Return h clipped at limit / bins, with the excess distributed in proportion to the room below that."""
    top = min(limit / len(h), 1.0)
    h = np.minimum(h, top)
    room = top - h
    excess = 1 - h.sum()
    return h + room * (excess / max(room.sum(), 1e-12))


def cumulative(h: F64) -> F64:
    """Return P at the edges of the bins."""
    return np.minimum(np.concatenate([[0], np.cumsum(h)]), 1)


def check_knobs(bins: int, limit: float) -> None:
    """Raise a ValueError unless there is a bin and the limit is at least 1."""
    if not (bins >= 1 and limit >= 1):
        raise InputError(
            f"expected at least 1 bin and a limit of at least 1, got {bins=} and {limit=}"
        )


def equalise(L: F32, *, bins: int = 1024, limit: float = 4.0) -> F32:
    """Return Ld = decode(P(ln L)) of a window, or of a whole picture."""
    check_knobs(bins, limit)
    low, high = find_range(L)
    t = bin_position(L, low, high, bins)
    h = clip_histogram(histogram(t, bins), limit=limit)
    P = cumulative(h)
    return np.interp(t, np.arange(bins + 1), colour.decode_srgb(P)).astype(np.float32)


def place_window(
    shape: tuple[int, ...], centre: tuple[float, float], side: int
) -> tuple[slice, slice]:
    """Return rows and columns of a square window around `centre` (y, x), moved to lie in the picture."""
    height, width = shape
    y, x = centre
    return _place_interval(y, side, height), _place_interval(x, side, width)


def _place_interval(centre: float, length: int, end: int) -> slice:
    """Return `length` pixels around `centre`, moved to lie between 0 and `end`."""
    start = int(np.clip(round(centre - length / 2), 0, max(0, end - length)))
    return slice(start, min(start + length, end))


def lens(
    L: ArrayLike,
    centre: tuple[float, float],
    *,
    size: int = 256,
    magnification: int = 1,
    bins: int = 1024,
    limit: float = 4.0,
) -> F32:
    """Return display luminance of a window around `centre`, equalized by its own histogram and enlarged.

    Parameters
    ----------
    L : (H, W) luminance, finite and not negative, any linear unit
    centre : (y, x) of the window, pixels of L; at the edge, the window stays inside the picture
    size : side of the enlarged window, pixels of the display
    magnification : pixels of the display per pixel of L, along each side
    bins, limit : as for `tonemap`

    Returns
    -------
    (size, size) float32 in [0, 1], display luminance; smaller if L is

    Raises
    ------
    ValueError
        For luminance that is not (H, W), finite and at least 0, and parameters out of range.

    References
    ----------
    Mitsunaga and Nayar, Radiometric self calibration, CVPR 1999.

    Examples
    --------
    >>> L = np.geomspace(1, 1e6, 100)[None] * np.ones((100, 1))
    >>> lens(L, (50, 20), size=40, magnification=2).shape
    (40, 40)
    """
    if not (1 <= magnification <= size):
        raise InputError(f"expected 1 <= magnification <= size, got {magnification=} and {size=}")
    if np.shape(centre) != (2,) or not np.all(np.isfinite(centre)):
        raise InputError(f"expected the centre (y, x) of the brush, got {centre}")
    L = as_luminance(L)
    side = math.ceil(size / magnification)
    rows, columns = place_window(L.shape, centre, side)
    Ld = equalise(L[rows, columns], bins=bins, limit=limit)
    return Ld.repeat(magnification, axis=0).repeat(magnification, axis=1)[:size, :size]


def tonemap(L: ArrayLike, *, bins: int = 1024, limit: float = 4.0) -> F32:
    """Return display luminance by histogram equalization of ln L over the whole picture.

    Parameters
    ----------
    L : (H, W) luminance, finite and not negative, any linear unit
    bins : number of bins of the histogram of ln L
    limit : largest count of a bin, in mean counts; 1 is the logarithm, inf is full equalization

    Returns
    -------
    (H, W) float32 in [0, 1], 1 = white

    Raises
    ------
    ValueError
        For luminance that is not (H, W), finite and at least 0, and parameters out of range.

    References
    ----------
    Mitsunaga and Nayar, Radiometric self calibration, CVPR 1999.

    Examples
    --------
    >>> tonemap(np.array([[1.0, 10.0, 100.0, 1000.0, 10000.0]]), limit=1).round(2)
    array([[0.  , 0.  , 0.21, 1.  , 1.  ]], dtype=float32)
    """
    return equalise(as_luminance(L), bins=bins, limit=limit)
