"""Consistency of the frames with a reference frame at each pixel.

Z      pixel levels    (H, W, C) of a frame
E      radiance        (H, W, C), the estimate so far
V      its variance    (H, W, C), inf where a level is nothing but a bound
low    lower bound     (H, W, C), of frames that clip a pixel; `high` the upper one, of those that are dark
D      difference      a frame's radiance less the estimate, a mean over 5 x 5 pixels where both measure

The reference frame alone would leave its clipped and its dark pixels unknown, and the others as
noisy as one frame. So the other frames are compared, nearest exposures first, with the estimate
from all frames that joined before. A frame is consistent where |D| <= 3 sigma + tau E, where no
bound is violated, and where its neighbourhood is consistent too.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import maximum_filter, minimum_filter, uniform_filter

from hdrlab.core.arrays import F32, F64, Array, Mask
from hdrlab.radiance.deghosting.frames import Calibrated
from hdrlab.radiance.deghosting.regions import Box

# pixels of the means; over so many, noise averages out, but a thinner figure has little weight
BOX_SIDE = 5
# of the 25 pixels of a box: demosaicing and JPEG correlate the errors of neighbours
INDEPENDENT_PIXELS = 10
# pixels that a frame may be displaced after alignment
MAX_SHIFT = 0.5
MAX_STANDARD_DEVIATIONS = 3.0
# relative difference that is tolerated in a static scene, as no response is known much better
RELATIVE_TOLERANCE = 0.05


@dataclass(frozen=True)
class Estimate:
    """An estimate of radiance from some frames; all arrays are (H, W, C).

    Attributes
    ----------
    E : radiance
    V : its variance
    measured : True where E is a measurement, and no channel of the pixel is clipped, as in the
        merge
    low, high : bounds of the radiance
    """

    E: F32
    V: F32
    measured: Mask
    low: F32
    high: F32


def read_frame(taken: Calibrated, j: int, box: Box) -> Estimate:
    """Return the estimate of one frame in a box: E = exp x(Z), V = E^2 s2(Z), or a bound."""
    Z = taken.images[j][box]
    x = taken.x[j]
    E = _look_up(np.exp(x).astype(np.float32), Z)
    V = _look_up(taken.s2[j].astype(np.float32), Z) * E**2
    shown = np.ones(Z.shape[:2], bool) if taken.valid is None else taken.valid[j][box]
    shown = shown[..., None]
    clipped = (Z >= taken.top) & shown
    dark = (Z == 0) & shown
    V[clipped | dark | ~shown] = np.inf
    low = np.where(clipped, np.exp(x[:, taken.top]).astype(np.float32), np.float32(0))
    high = np.where(dark, np.exp(x[:, 1]).astype(np.float32), np.float32(np.inf))
    measured = np.isfinite(V) & ~clipped.any(axis=-1, keepdims=True)
    return Estimate(E=E, V=V, measured=measured, low=low, high=high)


def _look_up(tables: Array, Z: Array) -> Array:
    """Return the value of each level (H, W, C) from the tables (C, n) of the channels."""
    planes = [table[Z[..., c]] for c, table in enumerate(tables)]
    return np.stack(planes, axis=-1)


def find_consistent(known: Estimate, other: Estimate, *, tau: float) -> Mask:
    """Return where two estimates and their neighbourhoods are consistent, (H, W)."""
    both = known.measured & other.measured
    fraction = np.maximum(_box_mean(both), np.float32(1e-6))
    E = np.where(both, known.E, 0)
    mean = _box_mean(E) / fraction
    D = np.abs(_box_mean(np.where(both, other.E - known.E, 0))) / fraction
    # a running mean may be below 0 by rounding
    variance = np.maximum(_box_mean(np.where(both, known.V + other.V, 0)), 0)
    sigma = np.sqrt(variance / INDEPENDENT_PIXELS) / fraction
    filled = np.where(both, E, mean)
    size = (BOX_SIDE, BOX_SIDE, 1)
    local_range = maximum_filter(filled, size) - minimum_filter(filled, size)
    edges = local_range * np.float32(MAX_SHIFT / BOX_SIDE)
    differ = np.any(D > MAX_STANDARD_DEVIATIONS * sigma + tau * mean + edges, axis=-1)
    violated = np.any(_violates(known, other, tau) | _violates(other, known, tau), axis=-1)
    differ |= uniform_filter(violated.astype(np.float32), 3) > 0.5
    return ~maximum_filter(differ, BOX_SIDE)


def _box_mean(values: Array) -> F32:
    return uniform_filter(values.astype(np.float32), (BOX_SIDE, BOX_SIDE, 0))


def _violates(measurement: Estimate, bounds: Estimate, tau: float) -> Mask:
    """Return where one estimate lies beyond a bound of another."""
    margin = MAX_STANDARD_DEVIATIONS * np.sqrt(measurement.V)
    below = (measurement.E + margin) < bounds.low * np.float32(1 - tau)
    above = (measurement.E - margin) > bounds.high * np.float32(1 + tau)
    return below | above


def join(known: Estimate, other: Estimate, where: Mask) -> Estimate:
    """Return the estimate combined with another at some pixels: means by 1 / V, and the tighter bounds."""
    inside = where[..., None]
    joins = inside & other.measured
    with np.errstate(divide="ignore", invalid="ignore"):
        weight = known.V / (known.V + other.V)  # of the other estimate
        E = np.where(joins & known.measured, known.E + weight * (other.E - known.E), other.E)
        V = np.where(joins & known.measured, weight * other.V, other.V)
    low = np.maximum(known.low, np.where(inside, other.low, 0))
    high = np.minimum(known.high, np.where(inside, other.high, np.inf))
    return Estimate(
        E=np.where(joins, E, known.E),
        V=np.where(joins, V, known.V),
        measured=known.measured | joins,
        low=low.astype(np.float32),
        high=high.astype(np.float32),
    )


def order_by_exposure(reference: int, times: F64) -> list[int]:
    """Return the numbers of the frames, the reference first, then by distance in stops, shorter first.

    Examples
    --------
    >>> order_by_exposure(1, np.array([1.0, 2, 4, 8]))
    [1, 0, 2, 3]
    """
    stops = np.round(np.abs(np.log2(times / times[reference])), 3)
    rest = sorted((float(stops[j]), j) for j in range(len(times)) if j != reference)
    return [reference, *(j for _, j in rest)]


def consistent_steps(
    taken: Calibrated, reference: int, box: Box
) -> Iterator[tuple[int, Mask, Estimate]]:
    """Yield the number of each frame, its consistent pixels (h, w), and the estimate that includes it.

    The reference frame comes first.
    """
    known = read_frame(taken, reference, box)
    yield reference, np.ones(known.E.shape[:2], bool), known
    for j in order_by_exposure(reference, taken.times)[1:]:
        other = read_frame(taken, j, box)
        where = find_consistent(known, other, tau=RELATIVE_TOLERANCE)
        known = join(known, other, where)
        yield j, where, known


def find_consistent_frames(taken: Calibrated, reference: int, box: Box) -> Mask:
    """Return where each frame is consistent with the reference and the frames that joined it, (P, h, w) bool.

    Parameters
    ----------
    taken : Calibrated, from `frames.calibrate_frames`
    reference : number of the reference frame
    box : rows and columns to compare

    Examples
    --------
    >>> from hdrlab.radiance.deghosting.frames import calibrate_frames
    >>> images = np.full((2, 9, 30), 50, np.uint8)
    >>> images[1] = 100
    >>> images[1, :, 20:] = 180  # something bright appeared
    >>> linear = np.log(np.maximum(np.arange(256), 0.5) / 128)
    >>> taken = calibrate_frames(images, [1, 2], linear, np.full((9, 30), 50 / 128))
    >>> used = find_consistent_frames(taken, 0, (slice(None), slice(None)))
    >>> used[0].all(), int(used[1, 4].nonzero()[0].max())  # the other frame joins in part
    (np.True_, 15)
    """
    used = np.zeros((len(taken.images), *taken.images[0][box].shape[:2]), bool)
    for j, where, _ in consistent_steps(taken, reference, box):
        used[j] = where
    return used if taken.valid is None else used & taken.valid[:, *box]
