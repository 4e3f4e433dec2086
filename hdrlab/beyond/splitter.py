"""One lens, three sensors: beam splitters share out the light of one moment (Tocci et al., SIGGRAPH 2011).

E      radiance      (H, W) or (H, W, 3), in the unit that fills a pixel that gets all the light
e      share         (N,), of the light that each sensor gets, the most first
c      channel       (H, W) int, 0 to 2: the colour of each pixel, the same on all sensors; None on gray ones
Z      levels        (N, H, W) uint8 or uint16, linear
B, D   radiance that a brighter sensor saw, Z / e, and that of all darker ones together, (H, W)
u      share of the pixels around that are full in B, 0 to 1, in a window of 5 x 5
P      what a full pixel of B would have shown: D sum B / sum D over those around that are not full

All sensors see one picture at one time, so nothing can leave a ghost. And they see it through
splitters that throw nearly no light away: the second takes what the first reflects, and what it
reflects in turn goes back through the first, which lets most of it pass to the third sensor.

Merging does not average all sensors. Where the brightest is not full it is the cleanest, and is
taken alone; the others come in where it fills, gently, for their noise is greater: [Tocci11 sec. 5]
has four cases.
"""

from collections.abc import Iterator
from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.ndimage import uniform_filter

from hdrlab.beyond import assorted
from hdrlab.core.arrays import F64, Array, ArrayLike, Mask, NDArray, as_radiance, describe, levels
from hdrlab.core.filters.mosaic import as_channels, demosaic
from hdrlab.core.steps import last
from hdrlab.errors import InputError

# shares of the light, by the first pellicle, and by the second of what the first reflected
REFLECTANCES = (0.08, 0.06)
# of the top level: from here on a pixel counts as full
CLIPPING_LEVEL = 0.9
# pixels
WINDOW_SIDE = 5


class State(NamedTuple):
    """What the sensors from the darkest to this one say together.

    Attributes
    ----------
    sensor : which one came last, 0 the brightest
    E : (H, W), radiance, as the pixels see it
    case : (H, W) uint8, 1 to 4: which rule held, 0 of the darkest sensor, which has no darker one
    """

    sensor: int
    E: F64
    case: NDArray[np.uint8]


def shares(reflected: ArrayLike = REFLECTANCES) -> F64:
    """Return e (3,): 1 - r1, r1 (1 - r2), r1 r2 (1 - r1), back through the first  [Tocci11 sec. 3].

    Examples
    --------
    >>> shares().round(4)
    array([0.92  , 0.0752, 0.0044])
    """
    first, second = np.asarray(reflected, np.float64)
    return np.array([1 - first, first * (1 - second), first * second * (1 - first)])


def shoot(
    E: ArrayLike,
    e: ArrayLike,
    c: ArrayLike | None = None,
    *,
    full_well: float = np.inf,
    read_noise: float = 0.0,
    bits: int = 12,
    rng: int | np.random.Generator = 0,
) -> NDArray[np.uint16]:
    """Take one moment with all sensors.

    Parameters
    ----------
    E : (H, W) or (H, W, 3), radiance; 1 fills a pixel that gets all the light
    e : (N,), shares, above 0 and at most 1
    c : (H, W), channels of an RGB scene, such as a Bayer mosaic
    full_well, read_noise : electrons, of each sensor
    bits : of the converters, 8 to 16
    rng : seed, or a generator, which is advanced

    Returns
    -------
    Z : (N, H, W) uint16, brought to 16 bits

    Raises
    ------
    ValueError
        For radiance, shares or channels that do not fit together.

    Examples
    --------
    >>> shoot(np.full((1, 1), 0.5), [0.5, 0.25], bits=16).ravel()
    array([16384,  8192], dtype=uint16)
    """
    E = as_radiance(E)
    each = as_shares(e)
    rng = np.random.default_rng(rng)
    if not 8 <= bits <= 16:
        raise InputError(f"expected 8 to 16 bits, got {bits}")
    shoot_one = partial(
        assorted.shoot, full_well=full_well, read_noise=read_noise, bits=16, rng=rng
    )
    Z = np.stack([shoot_one(E, np.full(E.shape[:2], share), c) for share in each])
    step = 65535 / (2**bits - 1)
    return np.round(np.round(Z / step) * step).astype(np.uint16)


def full_share(full: Mask) -> F64:
    """Return u, the share of the window's pixels that are full."""
    return uniform_filter(full.astype(np.float64), WINDOW_SIDE, mode="nearest")


def predict_full(B: F64, D: F64, full: Mask) -> F64:
    """Return P = D sum B / sum D over the window's pixels that are not full [Tocci11 sec. 5].

    The paper takes the mean of the quotients B / D; that of the sums does not suffer from a D near
    zero.
    """
    b, d = (uniform_filter(np.where(full, 0, one), WINDOW_SIDE, mode="nearest") for one in (B, D))
    return np.where(d > 0, D * b / np.where(d > 0, d, 1), D)


def join_sensors(B: F64, D: F64, full: Mask) -> tuple[F64, NDArray[np.uint8]]:
    """Return the radiance of two sensors, and which of four cases each pixel is [Tocci11 sec. 5].

    1  nothing around is full          B
    2  something around is full        (1 - u) B + u D
    3  full, but not all around is     (1 - u) P + u D
    4  all is full                     D
    """
    u = full_share(full)
    some = u > 1e-9
    every = u > 1 - 1e-9
    own = np.where(full, predict_full(B, D, full), B)
    E = np.where(some, np.where(every, D, (1 - u) * own + u * D), B)
    return E, np.where(full, np.where(every, 4, 3), np.where(some, 2, 1)).astype(np.uint8)


def merge_steps(Z: ArrayLike, e: ArrayLike, *, full: float = CLIPPING_LEVEL) -> Iterator[State]:
    """Yield the State from the darkest sensor alone to all of them; parameters are those of `merge`."""
    each = as_shares(e)
    stack = np.asarray(Z)
    if stack.ndim != 3 or stack.dtype not in (np.uint8, np.uint16) or len(stack) != len(each):
        raise InputError(
            f"expected levels ({len(each)}, H, W), a picture per share, got {describe(stack)}"
        )
    if not 0 < full <= 1:
        raise InputError(f"expected a level that counts as full, above 0 and at most 1, got {full}")
    X = stack / (levels(stack) - 1)
    E = X[-1] / each[-1]
    yield State(len(each) - 1, E, np.zeros(E.shape, np.uint8))
    for j in range(len(each) - 2, -1, -1):
        E, case = join_sensors(X[j] / each[j], E, X[j] >= full)
        yield State(j, E, case)


def merge(
    Z: ArrayLike, e: ArrayLike, c: ArrayLike | None = None, *, full: float = CLIPPING_LEVEL
) -> Array:
    """Return the radiance of one moment, from all sensors.

    Parameters
    ----------
    Z : (N, H, W) uint8 or uint16, linear, black at 0
        The sensors' pictures, that with the most light first.
    e : (N,) float
        Their shares of the light.
    c : (H, W) int, optional
        Channels of a colour mosaic; the merged mosaic is interpolated after merging.
    full : float
        The level, 1 the top, from which on a pixel counts as full.

    Returns
    -------
    E : (H, W) or (H, W, 3) float32
        Where the darkest sensor is full, the least that the light can be.

    Raises
    ------
    ValueError
        For pictures and shares that do not fit together.

    References
    ----------
    Tocci, Kiser, Tocci and Sen, A versatile HDR video production system, SIGGRAPH 2011.

    Examples
    --------
    >>> E = np.geomspace(0.01, 100, 25) * np.ones((25, 1))
    >>> back = merge(shoot(E, shares()), shares())
    >>> bool(np.abs(back / E - 1).max() < 0.03)
    True
    """
    E = last(merge_steps(Z, e, full=full)).E.astype(np.float32)
    return E if c is None else demosaic(E, as_channels(c, E.shape))


def as_shares(e: ArrayLike) -> F64:
    """Return shares (N,), falling, at most 1 in all, or raise a ValueError."""
    each = np.asarray(e, np.float64)
    falling = each.ndim == 1 and len(each) and np.all(each > 0) and np.all(np.diff(each) < 0)
    if not (falling and each.sum() < 1.001):
        raise InputError(
            f"expected positive, falling shares of the light, at most 1 in all, got {each}"
        )
    return each
