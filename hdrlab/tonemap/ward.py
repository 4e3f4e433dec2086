"""Histogram adjustment (Ward Larson, Rushmeier, Piatko, IEEE Visualization and Computer Graphics 3(4), 1997).

L          luminance                (H, W) >= 0, any linear unit
Lf         foveal image             one value per degree of view: what an eye adapts to when it looks there
b          brightness, ln Lf        `bins` of them between Lmin and Lmax, db wide
h          histogram                (bins,) foveal pixels of each brightness; f in the paper
T          their sum                trims end below 2.5 % of it, as in pcond; in the paper of the first T
P          cumulative distribution  at the edges of the bins, (bins + 1,), 1 at the last
Ldmin ...  the display's black and white, cd/m^2;   D = ln Ldmax - ln Ldmin, its range
Ld         display luminance        cd/m^2, Ldmin to Ldmax

Equalising the histogram gives every brightness its share of the display's range, and exaggerates
the contrast of those that fill the picture. So the histogram is trimmed until nothing is shown with
more contrast than it has. The paper's models of the eye are not here: the ceiling from contrast
sensitivity, veiling glare, loss of colour and of acuity in the dark.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from hdrlab.core import extremes, steps
from hdrlab.core.arrays import F32, F64, ArrayLike, as_luminance
from hdrlab.errors import InputError

LAWS = ("monotone", "exposure")
TINY = np.finfo(np.float32).tiny


class Trim(NamedTuple):
    """The histogram after a trim.

    Attributes
    ----------
    h : (bins,), nothing above `ceiling`
    ceiling : counts, from the T before this trim; infinite before the first
    T : that T; P = sum of h / T has slopes of at most 1
    trimmings : what was cut off
    """

    h: F64
    ceiling: float
    T: float
    trimmings: float


def foveal_image(L: F32, *, field: float = 60.0) -> F32:
    """Return Lf, the mean of each square degree where the longer side spans `field` degrees of view.

    The degrees are evenly spread over the picture's plane; a small picture is its own foveal image.
    """
    size = max(max(L.shape) / field, 1)
    return average_rows(average_rows(L, size).T, size).T


def average_rows(L: F32, size: float) -> F32:
    """Return the means of runs of about `size` rows."""
    run = (np.arange(len(L)) / size).astype(int)
    starts = np.flatnonzero(np.diff(run)) + 1
    return np.stack([rows.mean(axis=0) for rows in np.split(L, starts)])


def histogram(Lf: F32, *, low: float, high: float, bins: int = 100) -> tuple[F64, float]:
    """Return h over ln L from ln Lmin to ln Lmax, and db; what is beyond counts in the bin at that end."""
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
    """Return P(b), the share of T below each edge of the bins [Battiato08 eq. 1.22], 1 at the last edge.

    T is that of the ceiling, so no slope exceeds 1; the last trimmings, which it still counts, lie
    below the first edge.
    """
    return 1 - np.append(np.cumsum(state.h[::-1])[::-1], 0) / state.T


def fill_gaps(state: Trim, db: float, D: float) -> F64:
    """Return P where the trims left nothing, yet the scene's range is wider than the display's.

    So it is where few brightnesses fill the picture, as in a chart: at a slope of 1 they use less
    than the display has. The rest goes to the gaps between, to each bin by its distance from a
    slope of 1. The paper's linear map would show a gray chart with one lamp as black.
    """
    slope = state.h / state.ceiling
    room = 1 - slope
    left = D / db - slope.sum()
    return np.append(0, np.minimum(np.cumsum(slope + room * (left / room.sum())) * (db / D), 1))


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
    """Return (ln L, ln Ld), the operator's curve at the edges of the bins.

    Where the trims leave nothing it is the linear map, Ld = L Ldmax / Lmax, if that fits; else
    `fill_gaps`.
    """
    if not (0 < black < white < np.inf and bins >= 1 and field > 0 and 0 < tolerance < 1):
        got = f"{black=}, {white=}, {bins=}, {field=}, {tolerance=}"
        raise InputError(
            f"expected 0 < black < white, bins >= 1, field > 0, 0 < tolerance < 1, got {got}"
        )
    Lf = foveal_image(L, field=field)
    low, high = extremes.robust_minimum(Lf), extremes.robust_maximum(Lf)
    if not low < high:
        low, high = (high or 1.0) / np.e, high or 1.0
    (h, db), D = histogram(Lf, low=low, high=high, bins=bins), np.log(white / black)
    state = steps.last(adjust_steps(h, db, D, tolerance=tolerance))
    empty = state.h.sum() <= tolerance * h.sum()
    if empty and np.log(high / low) <= D:
        low, P = high * black / white, np.linspace(0, 1, bins + 1)
    else:
        P = fill_gaps(state, db, D) if empty else cumulative(state)
    return np.linspace(np.log(low), np.log(high), bins + 1), equalise(P, black=black, white=white)


def display(L: F32, lnL: F64, lnLd: F64, *, black: float, white: float) -> F32:
    """Return (Ld - Ldmin) / (Ldmax - Ldmin) of each pixel, read from the curve."""
    Ld = np.exp(np.interp(np.log(np.maximum(L, TINY)), lnL, lnLd))
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
    """Return display luminance by equalising the histogram of brightness, no contrast above the scene's.

    Parameters
    ----------
    L : (H, W) luminance, finite and not negative, any linear unit
    black, white : the display's, cd/m^2; only their ratio counts
    bins : of the histogram
    field : degrees of view that the picture's longer side spans
    tolerance : share of the histogram; fewer trimmings end the trims

    Returns
    -------
    (H, W) float32 in [0, 1]: (Ld - Ldmin) / (Ldmax - Ldmin), for the display adds its black by
    itself

    Raises
    ------
    ValueError
        For luminance that is not (H, W), finite and positive or zero, and knobs out of range.

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
