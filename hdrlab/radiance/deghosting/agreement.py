"""Which frames tell the story of a leading one: the others join it where they agree, and nowhere else.

Z      pixel levels    (H, W, C) of a frame
E      radiance        (H, W, C), what is known so far
V      its variance    (H, W, C), inf where a level says nothing but a bound
low    lower bound     (H, W, C), of frames that clip a pixel; `high` the upper one, of those that are dark
D      difference      a frame's radiance less what is known, a mean over 5 x 5 pixels where both measure

The leader alone would leave its clipped and its dark pixels open, and the noise of one frame in the others.
Frame after frame, the nearest exposures first, the next is compared with all that joined before. It agrees
where |D| <= 3 sigma + tau E, where besides no bound is broken, and where its neighbourhood agrees, too.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter, minimum_filter, uniform_filter

from hdrlab.core.arrays import Array
from hdrlab.radiance.deghosting.frames import Photographs

Float = NDArray[np.float32]
Mask = NDArray[np.bool_]
Box = tuple[slice, slice]
BOX = 5  # pixels: noise averages out, and a figure that is thinner counts for little
ALONE = 10  # of a box's 25 pixels, so many err by themselves, for neighbours err alike (demosaicing, JPEG)
SHIFT = 0.5  # pixels that a frame may lie beside another after alignment
SIGMAS = 3.0
TAU = 0.05  # relative difference of a still scene: no response is known much better


class Known(NamedTuple):
    """What some frames say of the pixels, (H, W, C) each.

    E and V; whether that is a measurement to the merge, which takes none of a pixel with a clipped channel;
    and bounds.
    """

    E: Float
    V: Float
    measured: Mask
    low: Float
    high: Float


def reading(taken: Photographs, j: int, box: Box) -> Known:
    """Return what a frame says by itself in a box: E = exp x(Z), V = E^2 s2(Z), or a bound."""
    Z, x = taken.images[j][box], taken.x[j]
    E = np.stack([np.exp(x[c]).astype(np.float32)[Z[..., c]] for c in range(len(x))], axis=-1)
    V = np.stack([taken.s2[j, c].astype(np.float32)[Z[..., c]] for c in range(len(x))], axis=-1) * E**2
    seen = np.ones((*Z.shape[:2], 1), bool) if taken.valid is None else taken.valid[j][box][..., None]
    clipped, dark = (Z >= taken.top) & seen, (Z == 0) & seen
    V[clipped | dark | ~seen] = np.inf
    low = np.where(clipped, np.exp(x[:, taken.top]).astype(np.float32), np.float32(0))
    high = np.where(dark, np.exp(x[:, 1]).astype(np.float32), np.float32(np.inf))
    return Known(E, V, np.isfinite(V) & ~clipped.any(axis=-1, keepdims=True), low, high)


def agrees(known: Known, other: Known, *, tau: float) -> Mask:
    """Return where a reading agrees with what is known, with all its neighbourhood, (H, W)."""
    both = known.measured & other.measured
    share = np.maximum(_box(both), np.float32(1e-6))
    E = np.where(both, known.E, 0)
    mean = _box(E) / share
    D = np.abs(_box(np.where(both, other.E - known.E, 0))) / share
    sigma = np.sqrt(_box(np.where(both, known.V + other.V, 0))) / (ALONE**0.5 * share)
    filled = np.where(both, E, mean)
    size = (BOX, BOX, 1)
    reach = (maximum_filter(filled, size) - minimum_filter(filled, size)) * np.float32(SHIFT / BOX)
    differ = np.any(D > SIGMAS * sigma + tau * mean + reach, axis=-1)
    broken = np.any(_breaks(known, other, tau) | _breaks(other, known, tau), axis=-1)
    differ |= uniform_filter(broken.astype(np.float32), 3) > 0.5
    return ~maximum_filter(differ, BOX)


def _box(values: Array) -> Float:
    return uniform_filter(values.astype(np.float32), (BOX, BOX, 0))


def _breaks(one: Known, other: Known, tau: float) -> Mask:
    """Return where a measurement of one lies beyond a bound of the other."""
    spare = SIGMAS * np.sqrt(one.V)
    below = (one.E + spare) < other.low * np.float32(1 - tau)
    return below | ((one.E - spare) > other.high * np.float32(1 + tau))


def joined(known: Known, other: Known, where: Mask) -> Known:
    """Return what is known with a reading that joins it somewhere: means by 1 / V, and the tighter bounds."""
    here = where[..., None]
    joins = here & other.measured
    with np.errstate(divide="ignore", invalid="ignore"):
        share = known.V / (known.V + other.V)  # of the other one
        E = np.where(joins & known.measured, known.E + share * (other.E - known.E), other.E)
        V = np.where(joins & known.measured, share * other.V, other.V)
    E, V = np.where(joins, E, known.E), np.where(joins, V, known.V)
    low = np.maximum(known.low, np.where(here, other.low, 0))
    high = np.minimum(known.high, np.where(here, other.high, np.inf))
    return Known(E, V, known.measured | joins, low.astype(np.float32), high.astype(np.float32))


def order(lead: int, times: NDArray[np.float64]) -> list[int]:
    """Return the frames, the leader first, then by how many stops they lie from it, shorter ones first.

    Examples
    --------
    >>> order(1, np.array([1.0, 2, 4, 8]))
    [1, 0, 2, 3]
    """
    stops = np.round(np.abs(np.log2(times / times[lead])), 3)
    rest = sorted((float(stops[j]), j) for j in range(len(times)) if j != lead)
    return [lead, *(j for _, j in rest)]


def following_steps(
    taken: Photographs, lead: int, box: Box, *, tau: float = TAU
) -> Iterator[tuple[int, Mask, Known]]:
    """Yield each frame's number, where it joins (h, w), and what is known then; the leader comes first."""
    known = reading(taken, lead, box)
    yield lead, np.ones(known.E.shape[:2], bool), known
    for j in order(lead, taken.times)[1:]:
        other = reading(taken, j, box)
        where = agrees(known, other, tau=tau)
        known = joined(known, other, where)
        yield j, where, known


def following(taken: Photographs, lead: int, box: Box, *, tau: float = TAU) -> Mask:
    """Return where each frame agrees with the leader and those that joined it before, (P, h, w) bool.

    Parameters
    ----------
    taken : Photographs, of `frames.photographs`
    lead : number of the leading frame
    box : rows and columns to look at
    tau : relative difference that a still scene may show

    Examples
    --------
    >>> from hdrlab.radiance.deghosting.frames import photographs
    >>> images = np.full((2, 9, 30), 50, np.uint8)
    >>> images[1] = 100
    >>> images[1, :, 20:] = 180  # something bright came
    >>> linear = np.log(np.maximum(np.arange(256), 0.5) / 128)
    >>> taken = photographs(images, [1, 2], linear, np.full((9, 30), 50 / 128))
    >>> shown = following(taken, 0, (slice(None), slice(None)))
    >>> shown[0].all(), int(shown[1, 4].nonzero()[0].max())  # the one leads, the other joins it in part
    (np.True_, 15)
    """
    y, x = box
    shown = np.zeros((len(taken.images), *taken.images[0][y, x].shape[:2]), bool)
    for j, where, _ in following_steps(taken, lead, box, tau=tau):
        shown[j] = where
    return shown if taken.valid is None else shown & taken.valid[:, y, x]
