"""Local histogram equalisation: the Detail Brush (Mitsunaga and Nayar, CVPR 1999, sec. 7).

L    luminance                (H, W) >= 0, any linear unit
b    ln L                     `bins` between the darkest and the brightest of the window
h    histogram                (bins,), shares of the window's pixels, sum 1
P    cumulative distribution  at the edges of the bins, (bins + 1,), 0 to 1
Ld   display luminance        decode(P(ln L)), in [0, 1]: P is the code of the display, every code for as many

A window's histogram knows nothing of the rest of the scene, so detail shows in a window that no
picture of the whole has room for. The histogram is clipped, as in adaptive equalisation
(Zuiderveld, Graphics Gems IV, 1994): no bin counts more than `limit` times an even share, and what
is cut off fills the others. So a limit of 1 is the plain logarithm; without one the equalisation is
full, and shows the noise of flat walls.
"""

import numpy as np

from hdrlab.core import colour, extremes
from hdrlab.core.arrays import F32, F64, ArrayLike, as_luminance
from hdrlab.errors import InputError

LAWS = ("monotone", "exposure")
# ratio of luminances that the bins span at least: what is flatter is not stretched further
SMALLEST_RANGE = 2.0
TINY = np.finfo(np.float32).tiny


def find_range(L: F32) -> tuple[float, float]:
    """Return the darkest and the brightest of the window but for 0.01 %, at least a stop apart."""
    low, high = extremes.robust_minimum(L) or 1.0, extremes.robust_maximum(L) or 1.0
    widen = max(1.0, SMALLEST_RANGE * low / high) ** 0.5
    return low / widen, high * widen


def bin_position(L: F32, low: float, high: float, bins: int) -> F32:
    """Return where ln L lies among the edges of the bins, 0 to `bins` from ln low to ln high."""
    b = np.log(np.maximum(L, TINY))
    return (b - np.float32(np.log(low))) * np.float32(bins / np.log(high / low))


def histogram(t: F32, bins: int = 1024) -> F64:
    """Return h, the shares of the pixels at positions t; what lies beyond counts in the bin at that end.

    A pixel counts in the two bins whose centres it lies between, so that none jumps from one to the
    next.
    """
    t = np.clip(t - np.float32(0.5), 0, bins - 1).ravel()
    left = t.astype(np.intp)
    shared = np.bincount(left, t - left, bins)
    return (np.bincount(left, minlength=bins) - shared + np.append(0, shared[:-1])) / t.size


def clip_histogram(h: F64, *, limit: float = 4.0) -> F64:
    """Return h cut at limit / bins, and what was cut off given to all bins as they have room below that."""
    top = min(limit / len(h), 1.0)
    h = np.minimum(h, top)
    room = top - h
    return h + room * ((1 - h.sum()) / max(room.sum(), 1e-12))


def cumulative(h: F64) -> F64:
    """Return P at the edges of the bins."""
    return np.minimum(np.concatenate([[0], np.cumsum(h)]), 1)


def check_knobs(bins: int, limit: float) -> None:
    """Raise a ValueError where there is no bin, or a limit below an even share."""
    if not (bins >= 1 and limit >= 1):
        raise InputError(
            f"expected at least 1 bin and a limit of at least 1, got {bins=} and {limit=}"
        )


def equalise(L: F32, *, bins: int = 1024, limit: float = 4.0) -> F32:
    """Return Ld = decode(P(ln L)) for a window, or for a whole picture."""
    check_knobs(bins, limit)
    t = bin_position(L, *find_range(L), bins)
    P = cumulative(clip_histogram(histogram(t, bins), limit=limit))
    return np.interp(t, np.arange(bins + 1), colour.decode_srgb(P)).astype(np.float32)


def place_window(
    shape: tuple[int, ...], centre: tuple[float, float], side: int
) -> tuple[slice, slice]:
    """Return rows and columns of a square window around `centre` (y, x), moved to lie in the picture."""
    corners = (
        int(np.clip(round(c - side / 2), 0, max(0, n - side)))
        for c, n in zip(centre, shape, strict=True)
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
) -> F32:
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
    if not (1 <= magnification <= size):
        raise InputError(f"expected 1 <= magnification <= size, got {magnification=} and {size=}")
    if np.shape(centre) != (2,) or not np.all(np.isfinite(centre)):
        raise InputError(f"expected the centre (y, x) of the brush, got {centre}")
    L = as_luminance(L)
    rows, columns = place_window(L.shape[:2], centre, -(-size // magnification))
    Ld = equalise(L[rows, columns], bins=bins, limit=limit)
    return Ld.repeat(magnification, axis=0).repeat(magnification, axis=1)[:size, :size]


def tonemap(L: ArrayLike, *, bins: int = 1024, limit: float = 4.0) -> F32:
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
    return equalise(as_luminance(L), bins=bins, limit=limit)
