"""Histogram adjustment (Ward Larson, Rushmeier, Piatko, IEEE Visualization and Computer Graphics 3(4), 1997).

L          luminance                (H, W) >= 0, any linear unit
Lf         foveal image             one value per degree of view: the luminance that an eye adapts to there
b          brightness, ln Lf        `bins` bins between Lmin and Lmax, each db wide
h          histogram                (bins,) foveal pixels of each brightness; f in the paper
T          their sum                the trims end when a trim cuts off less than 2.5 % of it, as in the
                                    program pcond; the paper compares with the first T
P          cumulative distribution  at the edges of the bins, (bins + 1,), 1 at the last
Ldmin ...  the display's black and white, cd/m^2;   D = ln Ldmax - ln Ldmin, its range
Ld         display luminance        cd/m^2, Ldmin to Ldmax

Histogram equalization gives each brightness a part of the display's range in proportion to its
count. This exaggerates the contrast of brightnesses that fill the picture. So the histogram is
trimmed until nothing is shown with more contrast than it has in the scene. The paper's models of
the eye are left out: the ceiling from contrast sensitivity, veiling glare, and the loss of colour
and of acuity in the dark.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from hdrlab.core import extremes, steps
from hdrlab.core.arrays import F32, F64, ArrayLike, as_luminance
from hdrlab.errors import InputError

LAWS = ("monotone", "exposure")
SMALLEST_FLOAT32 = np.finfo(np.float32).tiny


class Trim(NamedTuple):
    """The histogram after a trim.

    Attributes
    ----------
    h : (bins,), nothing above `ceiling`
    ceiling : counts, from the T before this trim; infinite before the first
    T : the sum of h before this trim; P = sum of h / T has slopes of at most 1
    trimmings : what was cut off
    """

    h: F64
    ceiling: float
    T: float
    trimmings: float


def foveal_image(L: F32, *, field: float = 60.0) -> F32:
    """Return Lf, the mean luminance of each square degree of view.

    The longer side of the picture spans `field` degrees, spread evenly over the picture's plane. A
    picture with less than a pixel per degree is its own foveal image.
    """
    size = max(max(L.shape) / field, 1)
    return average_rows(average_rows(L, size).T, size).T


def average_rows(L: F32, size: float) -> F32:
    """Return the means of runs of about `size` rows."""
    run = (np.arange(len(L)) / size).astype(int)
    starts = np.flatnonzero(np.diff(run)) + 1
    return np.stack([rows.mean(axis=0) for rows in np.split(L, starts)])


def histogram(Lf: F32, *, low: float, high: float, bins: int = 100) -> tuple[F64, float]:
    """Return the histogram h of ln L between ln Lmin and ln Lmax, and the width db of its bins.

    Pixels outside of that range count in the first or the last bin.
    """
    b = np.log(np.clip(Lf[Lf > 0], low, high), dtype=np.float64)
    h, edges = np.histogram(b, bins, range=(np.log(low), np.log(high)))
    return h.astype(np.float64), float(edges[1] - edges[0])


def ceiling(T: float, db: float, D: float) -> float:
    """Return T db / D: above it, d ln Ld / d ln L > 1 [Battiato08 eq. 1.26, whose L_din is Ldmin]."""
    return T * db / D


def trim(h: F64, db: float, D: float) -> Trim:
    """Return h cut at its ceiling. The trimmings are not put elsewhere: that would raise another slope."""
    T = float(h.sum())
    top = ceiling(T, db, D)
    return Trim(np.minimum(h, top), top, T, float(np.maximum(h - top, 0).sum()))


def adjust_steps(h: F64, db: float, D: float, *, tolerance: float = 0.025) -> Iterator[Trim]:
    """Yield the histogram as it is, and after every trim.

    A trim lowers T and so the next ceiling. It ends when trimmings are below `tolerance` of T; or
    when no more than `tolerance` of the first T is left: the display has range enough for all
    contrast.
    """
    state = Trim(h, np.inf, float(h.sum()), np.inf)
    yield state
    while state.trimmings >= tolerance * state.T and state.h.sum() > tolerance * h.sum():
        state = trim(state.h, db, D)
        yield state


def cumulative(state: Trim) -> F64:
    """Return P(b), the fraction of T below each edge of the bins [Battiato08 eq. 1.22], 1 at the last.

    T is the sum that the ceiling came from, so no slope exceeds 1. It still includes the last
    trimmings; they are counted below the first edge.
    """
    above = np.append(np.cumsum(state.h[::-1])[::-1], 0)
    return 1 - above / state.T


def fill_gaps(state: Trim, db: float, D: float) -> F64:
    """Return P for a scene that the trims emptied although its range is wider than the display's.

    This happens where a few brightnesses fill the picture, as in a chart: with a slope of 1 they
    use less than the display's range. The rest of the range is divided among the bins, in
    proportion to how far each one is below a slope of 1. The paper's linear map would show a gray
    chart with one lamp as black.
    """
    slope = state.h / state.ceiling
    room = 1 - slope
    left = D / db - slope.sum()
    filled = slope + room * (left / room.sum())
    return np.append(0, np.minimum(np.cumsum(filled) * (db / D), 1))


def equalise(P: F64, *, black: float, white: float) -> F64:
    """Return ln Ld = ln Ldmin + (ln Ldmax - ln Ldmin) P [Battiato08 eq. 1.24]."""
    return np.log(black) + np.log(white / black) * P


def curve(
    L: F32,
    *,
    black: float = 1.0,
    white: float = 100.0,
    bins: int = 100,
    field: float = 60.0,
    tolerance: float = 0.025,
) -> tuple[F64, F64]:
    """Return the operator's curve at the edges of the bins as (ln L, ln Ld).

    Where the trims leave next to nothing, the curve is the linear map Ld = L Ldmax / Lmax if the
    scene's range fits the display, and that of `fill_gaps` otherwise.
    """
    if not (0 < black < white < np.inf and bins >= 1 and field > 0 and 0 < tolerance < 1):
        got = f"{black=}, {white=}, {bins=}, {field=}, {tolerance=}"
        raise InputError(
            f"expected 0 < black < white, bins >= 1, field > 0, 0 < tolerance < 1, got {got}"
        )
    Lf = foveal_image(L, field=field)
    low, high = range_of_luminance(Lf)
    h, db = histogram(Lf, low=low, high=high, bins=bins)
    D = np.log(white / black)
    state = steps.last(adjust_steps(h, db, D, tolerance=tolerance))
    is_empty = state.h.sum() <= tolerance * h.sum()
    if not is_empty:
        P = cumulative(state)
    elif np.log(high / low) <= D:
        low = high * black / white
        P = np.linspace(0, 1, bins + 1)
    else:
        P = fill_gaps(state, db, D)
    lnL = np.linspace(np.log(low), np.log(high), bins + 1)
    return lnL, equalise(P, black=black, white=white)


def range_of_luminance(Lf: F32) -> tuple[float, float]:
    """Return Lmin and Lmax of the foveal image; for a constant image, Lmin = Lmax / e."""
    low = extremes.robust_minimum(Lf)
    high = extremes.robust_maximum(Lf)
    if low < high:
        return low, high
    high = high or 1.0  # of a black image
    return high / np.e, high


def display(L: F32, lnL: F64, lnLd: F64, *, black: float, white: float) -> F32:
    """Return (Ld - Ldmin) / (Ldmax - Ldmin) of each pixel, interpolated on the curve."""
    Ld = np.exp(np.interp(np.log(np.maximum(L, SMALLEST_FLOAT32)), lnL, lnLd))
    return np.clip((Ld - black) / (white - black), 0, 1).astype(np.float32)


def tonemap(
    L: ArrayLike,
    *,
    black: float = 1.0,
    white: float = 100.0,
    bins: int = 100,
    field: float = 60.0,
    tolerance: float = 0.025,
) -> F32:
    """Return display luminance by histogram equalization that exaggerates no contrast of the scene.

    Parameters
    ----------
    L : (H, W) luminance, finite and not negative, any linear unit
    black, white : luminance of the display, cd/m^2; only their ratio matters
    bins : number of bins of the histogram
    field : degrees of view that the picture's longer side spans
    tolerance : fraction of the histogram; the trims end when one of them cuts off less

    Returns
    -------
    (H, W) float32 in [0, 1]: (Ld - Ldmin) / (Ldmax - Ldmin). The display itself adds its black.

    Raises
    ------
    ValueError
        For luminance that is not (H, W), finite and at least 0, and parameters out of range.

    References
    ----------
    Ward Larson, Rushmeier, Piatko, A visibility matching tone reproduction operator for high
    dynamic range scenes, IEEE Transactions on Visualization and Computer Graphics 3(4), 1997.

    Examples
    --------
    >>> tonemap(np.array([[0.0, 10.0, 20.0, 40.0, 90.0]]), white=1000.0).round(2).tolist()
    [[0.0, 0.25, 0.5, 1.0, 1.0]]
    """
    L = as_luminance(L)
    lnL, lnLd = curve(L, black=black, white=white, bins=bins, field=field, tolerance=tolerance)
    return display(L, lnL, lnLd, black=black, white=white)
