"""Which frames are consistent with a reference frame, pixel by pixel.

Z      pixel levels    (H, W, C) of a frame
E      radiance        (H, W, C), the estimate so far
V      its variance    (H, W, C), inf where a level is nothing but a bound
low    lower bound     (H, W, C), of frames that clip a pixel; `high` the upper one, of those that are dark
D      difference      a frame's radiance less the estimate, a mean over 5 x 5 pixels where both measure

The reference frame alone would leave its clipped and its dark pixels open, and the noise of one
frame in the others. Frame after frame, the nearest exposures first, the next is compared with the
estimate of all that joined before. It is consistent where |D| <= 3 sigma + tau E, where no bound is
violated, and where its neighbourhood is consistent, too.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from scipy.ndimage import maximum_filter, minimum_filter, uniform_filter

from hdrlab.core.arrays import F32, F64, Array, Mask
from hdrlab.radiance.deghosting.frames import Calibrated
from hdrlab.radiance.deghosting.regions import Box

# pixels: noise averages out, and a figure that is thinner counts for little
BOX = 5
# of a box's 25 pixels: neighbours have like errors (demosaicing, JPEG)
INDEPENDENT = 10
# pixels that a frame may be off after alignment
SHIFT = 0.5
SIGMAS = 3.0
# relative difference of a still scene: no response is known much better
TAU = 0.05


class Estimate(NamedTuple):
    """The pixels' radiance from some frames, (H, W, C) each.

    E and V; whether that is a measurement to the merge, which takes none of a pixel with a clipped
    channel; and bounds.
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
    E = np.stack([np.exp(x[c]).astype(np.float32)[Z[..., c]] for c in range(len(x))], axis=-1)
    V = (
        np.stack([taken.s2[j, c].astype(np.float32)[Z[..., c]] for c in range(len(x))], axis=-1)
        * E**2
    )
    shown = (
        np.ones((*Z.shape[:2], 1), bool) if taken.valid is None else taken.valid[j][box][..., None]
    )
    clipped = (Z >= taken.top) & shown
    dark = (Z == 0) & shown
    V[clipped | dark | ~shown] = np.inf
    low = np.where(clipped, np.exp(x[:, taken.top]).astype(np.float32), np.float32(0))
    high = np.where(dark, np.exp(x[:, 1]).astype(np.float32), np.float32(np.inf))
    return Estimate(E, V, np.isfinite(V) & ~clipped.any(axis=-1, keepdims=True), low, high)


def find_consistent(known: Estimate, other: Estimate, *, tau: float) -> Mask:
    """Return where two estimates are consistent, with all of the neighbourhood, (H, W)."""
    both = known.measured & other.measured
    share = np.maximum(_box_mean(both), np.float32(1e-6))
    E = np.where(both, known.E, 0)
    mean = _box_mean(E) / share
    D = np.abs(_box_mean(np.where(both, other.E - known.E, 0))) / share
    # a running mean rounds below 0, too
    sigma = (
        np.sqrt(np.maximum(_box_mean(np.where(both, known.V + other.V, 0)), 0) / INDEPENDENT)
        / share
    )
    filled = np.where(both, E, mean)
    size = (BOX, BOX, 1)
    reach = (maximum_filter(filled, size) - minimum_filter(filled, size)) * np.float32(SHIFT / BOX)
    differ = np.any(D > SIGMAS * sigma + tau * mean + reach, axis=-1)
    violated = np.any(_violates(known, other, tau) | _violates(other, known, tau), axis=-1)
    differ |= uniform_filter(violated.astype(np.float32), 3) > 0.5
    return ~maximum_filter(differ, BOX)


def _box_mean(values: Array) -> F32:
    return uniform_filter(values.astype(np.float32), (BOX, BOX, 0))


def _violates(one: Estimate, other: Estimate, tau: float) -> Mask:
    """Return where a measurement of one lies beyond a bound of the other."""
    spare = SIGMAS * np.sqrt(one.V)
    below = (one.E + spare) < other.low * np.float32(1 - tau)
    return below | ((one.E - spare) > other.high * np.float32(1 + tau))


def join(known: Estimate, other: Estimate, where: Mask) -> Estimate:
    """Return the estimate with another that joins it somewhere: means by 1 / V, and the tighter bounds."""
    here = where[..., None]
    joins = here & other.measured
    with np.errstate(divide="ignore", invalid="ignore"):
        share = known.V / (known.V + other.V)  # of the other one
        E = np.where(joins & known.measured, known.E + share * (other.E - known.E), other.E)
        V = np.where(joins & known.measured, share * other.V, other.V)
    E = np.where(joins, E, known.E)
    V = np.where(joins, V, known.V)
    low = np.maximum(known.low, np.where(here, other.low, 0))
    high = np.minimum(known.high, np.where(here, other.high, np.inf))
    return Estimate(E, V, known.measured | joins, low.astype(np.float32), high.astype(np.float32))


def order_by_exposure(reference: int, times: F64) -> list[int]:
    """Return the frames, the reference first, then by how many stops they lie from it, shorter ones first.

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
    """Yield each frame's number, where it is consistent (h, w), and the estimate with it; reference first."""
    known = read_frame(taken, reference, box)
    yield reference, np.ones(known.E.shape[:2], bool), known
    for j in order_by_exposure(reference, taken.times)[1:]:
        other = read_frame(taken, j, box)
        where = find_consistent(known, other, tau=TAU)
        known = join(known, other, where)
        yield j, where, known


def find_consistent_frames(taken: Calibrated, reference: int, box: Box) -> Mask:
    """Return where each frame is consistent with the reference and those that joined it, (P, h, w) bool.

    Parameters
    ----------
    taken : Calibrated, of `frames.calibrate_frames`
    reference : number of the reference frame
    box : rows and columns to look at

    Examples
    --------
    >>> from hdrlab.radiance.deghosting.frames import calibrate_frames
    >>> images = np.full((2, 9, 30), 50, np.uint8)
    >>> images[1] = 100
    >>> images[1, :, 20:] = 180  # something bright came
    >>> linear = np.log(np.maximum(np.arange(256), 0.5) / 128)
    >>> taken = calibrate_frames(images, [1, 2], linear, np.full((9, 30), 50 / 128))
    >>> used = find_consistent_frames(taken, 0, (slice(None), slice(None)))
    >>> used[0].all(), int(used[1, 4].nonzero()[0].max())  # the other one joins the reference in part
    (np.True_, 15)
    """
    used = np.zeros((len(taken.images), *taken.images[0][box].shape[:2]), bool)
    for j, where, _ in consistent_steps(taken, reference, box):
        used[j] = where
    return used if taken.valid is None else used & taken.valid[:, *box]
