"""Histogram adjustment (Ward Larson, Rushmeier, Piatko, IEEE Visualization and Computer Graphics 3(4), 1997).

L          luminance                (H, W) >= 0, any linear unit
Lf         foveal image             one value per degree of view: what an eye adapts to when it looks there
b          brightness, ln Lf        `bins` of them between Lmin and Lmax, db wide
f          histogram                (bins,) foveal pixels of each brightness
T          their sum                trims end when they take less than 2.5 % of it
P          cumulative distribution  at the edges of the bins, (bins + 1,), 1 at the last
Ldmin ...  the display's black and white, cd/m^2;   D = ln Ldmax - ln Ldmin, its range
Ld         display luminance        cd/m^2, Ldmin to Ldmax

Equalising the histogram gives every brightness its share of the display's range, and exaggerates the contrast
of those that fill the picture. So the histogram is trimmed until nothing is shown with more contrast than it
has. The paper's models of the eye are not here: the ceiling from contrast sensitivity, veiling glare, loss of
colour and of acuity in the dark.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core import lookup
from hdrlab.core.arrays import as_luminance
from hdrlab.core.bands import banded
from hdrlab.core.extremes import robust_maximum, robust_minimum
from hdrlab.core.steps import last

Float = NDArray[np.float32]
Histogram = NDArray[np.float64]

LAWS = ("monotone", "exposure")
TINY = np.float32(np.finfo(np.float32).tiny)
KNOTS = 1 << 14  # of the curve, in all


class Trim(NamedTuple):
    """The histogram after a trim.

    Attributes
    ----------
    f : (bins,), nothing above `ceiling`
    ceiling : counts, from the T before this trim; infinite before the first
    T : that T; P = sum of f / T has slopes of at most 1
    trimmings : what was cut off
    """

    f: Histogram
    ceiling: float
    T: float
    trimmings: float


def foveal(L: Float, *, field: float = 60.0) -> Float:
    """Return Lf, the mean of each square degree where the longer side spans `field` degrees of view.

    The degrees are evenly spread over the picture's plane; a small picture is its own foveal image.
    """
    size = max(max(L.shape) / field, 1)
    return _averaged(_averaged(L, size).T, size).T


def _averaged(L: Float, size: float) -> Float:
    """Return the means of runs of about `size` rows."""
    run = (np.arange(len(L)) / size).astype(int)
    starts = np.flatnonzero(np.diff(run)) + 1
    return np.stack([rows.mean(axis=0) for rows in np.split(L, starts)])


def histogram(Lf: Float, *, low: float, high: float, bins: int = 100) -> tuple[Histogram, float]:
    """Return f over ln L from ln Lmin to ln Lmax, and db; what is beyond counts in the bin at that end."""
    b = np.log(np.clip(Lf[Lf > 0], low, high), dtype=np.float64)
    f, edges = np.histogram(b, bins, range=(np.log(low), np.log(high)))
    return f.astype(np.float64), float(edges[1] - edges[0])


def ceiling(T: float, db: float, D: float) -> float:
    """Return T db / D: above it, d ln Ld / d ln L > 1 [Battiato08 eq. 1.26, whose L_din is Ldmin]."""
    return T * db / D


def trim(f: Histogram, db: float, D: float) -> Trim:
    """Return f cut at its ceiling. The trimmings are not put elsewhere: that would raise another slope."""
    T = float(f.sum())
    top = ceiling(T, db, D)
    return Trim(np.minimum(f, top), top, T, float(np.maximum(f - top, 0).sum()))


def adjust_steps(f: Histogram, db: float, D: float, *, tolerance: float = 0.025) -> Iterator[Trim]:
    """Yield the histogram as it is, and after every trim.

    A trim lowers T and so the next ceiling. It ends when trimmings are below `tolerance` of T; or when no
    more than `tolerance` of the first T is left: the display has range enough for all contrast (`empty`).
    """
    state = Trim(f, np.inf, float(f.sum()), np.inf)
    enough = tolerance * state.T
    yield state
    while state.trimmings >= tolerance * state.T and not empty(state, enough):
        state = trim(state.f, db, D)
        yield state


def empty(state: Trim, enough: float) -> bool:
    """Return whether the trims leave nothing to equalise."""
    return bool(state.f.sum() <= enough)


def cumulative(state: Trim) -> Histogram:
    """Return P(b), the share of T below each edge of the bins [Battiato08 eq. 1.22], 1 at the last edge.

    T is that of the ceiling, so no slope exceeds 1; the last trimmings, which it still counts, lie below the
    first edge.
    """
    return 1 - np.append(np.cumsum(state.f[::-1])[::-1], 0) / state.T


def filled(state: Trim, db: float, D: float) -> Histogram:
    """Return P where the trims left nothing, yet the scene's range is wider than the display's.

    So it is where few brightnesses fill the picture, as in a chart: at a slope of 1 they use less than the
    display has. The rest goes to the gaps between, to each bin by its distance from a slope of 1. The paper's
    linear map would show a gray chart with one lamp as black.
    """
    slope = state.f / state.ceiling
    room = 1 - slope
    left = D / db - slope.sum()
    return np.append(0, np.minimum(np.cumsum(slope + room * (left / room.sum())) * (db / D), 1))


def equalised(P: Histogram, *, black: float, white: float) -> Histogram:
    """Return ln Ld = ln Ldmin + (ln Ldmax - ln Ldmin) P [Battiato08 eq. 1.24]."""
    return np.log(black) + np.log(white / black) * P


def displayed(lnLd: Histogram, *, black: float, white: float) -> Histogram:
    """Return (Ld - Ldmin) / (Ldmax - Ldmin) at the edges of the bins and at many knots between them.

    So close together that a line from knot to knot is the exponential: it is taken of knots, not of pixels.
    """
    bins = len(lnLd) - 1
    at = np.linspace(0, bins, bins * max(1, KNOTS // bins) + 1)
    Ld = np.exp(np.interp(at, np.arange(bins + 1), lnLd))
    return np.clip((Ld - black) / (white - black), 0, 1)


def curve(
    L: Float,
    *,
    black: float = 1.0,
    white: float = 100.0,
    bins: int = 100,
    field: float = 60.0,
    tolerance: float = 0.025,
) -> tuple[Histogram, Histogram]:
    """Return (ln L, ln Ld), the operator's curve at the edges of the bins.

    Where the trims leave nothing it is the linear map, Ld = L Ldmax / Lmax, if that fits; else `filled`.
    """
    Lf = foveal(L, field=field)
    low, high = robust_minimum(Lf), robust_maximum(Lf)
    if not low < high:
        low, high = (high or 1.0) / np.e, high or 1.0
    f, db = histogram(Lf, low=low, high=high, bins=bins)
    D = np.log(white / black)
    state = last(adjust_steps(f, db, D, tolerance=tolerance))
    nothing = empty(state, tolerance * f.sum())
    if nothing and np.log(high / low) <= D:
        P = np.linspace(0, 1, bins + 1)
        return np.log(high) - D * (1 - P), equalised(P, black=black, white=white)
    P = filled(state, db, D) if nothing else cumulative(state)
    return np.linspace(np.log(low), np.log(high), bins + 1), equalised(P, black=black, white=white)


def tonemap(
    L: ArrayLike,
    *,
    black: float = 1.0,
    white: float = 100.0,
    bins: int = 100,
    field: float = 60.0,
    tolerance: float = 0.025,
) -> Float:
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
    (H, W) float32 in [0, 1]: (Ld - Ldmin) / (Ldmax - Ldmin), for the display adds its black by itself

    Raises
    ------
    ValueError
        For luminance that is not (H, W), finite and positive or zero, and knobs out of range.

    References
    ----------
    Ward Larson, Rushmeier, Piatko, A visibility matching tone reproduction operator for high dynamic range
    scenes, IEEE Transactions on Visualization and Computer Graphics 3(4), 1997.

    Examples
    --------
    >>> tonemap(np.array([[0.0, 10.0, 20.0, 40.0, 90.0]]), white=1000.0).round(2).tolist()
    [[0.0, 0.25, 0.5, 1.0, 1.0]]
    """
    L = as_luminance(L)
    if not (0 < black < white < np.inf and bins >= 1 and field > 0 and 0 < tolerance < 1):
        raise ValueError(
            f"expected 0 < black < white, at least 1 bin, field > 0 and a tolerance in (0, 1), "
            f"got black={black}, white={white}, bins={bins}, field={field}, tolerance={tolerance}"
        )
    b, lnLd = curve(L, black=black, white=white, bins=bins, field=field, tolerance=tolerance)
    lines = lookup.lines(displayed(lnLd, black=black, white=white))
    scale = np.float32((len(lines) - 1) / (b[-1] - b[0]))

    def display(L: Float) -> Float:
        return lookup.along(lines, (np.log(np.maximum(L, TINY)) - np.float32(b[0])) * scale)

    return banded(display, L)
