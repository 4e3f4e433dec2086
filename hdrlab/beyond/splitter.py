"""One lens, three sensors: beam splitters divide the light of one moment (Tocci et al., SIGGRAPH 2011).

E      radiance      (H, W) or (H, W, 3), in the unit that fills a pixel that gets all the light
e      share         (N,), of the light that each sensor gets, largest first
c      channel       (H, W) int, 0 to 2: the colour of each pixel, the same on all sensors; None on gray ones
Z      levels        (N, H, W) uint8 or uint16, linear
B, D   radiance from a brighter sensor, Z / e, and that from all darker sensors, (H, W)
u      fraction of the pixels in a window of 5 x 5 that are full in B, 0 to 1
P      prediction of a full pixel of B: D sum B / sum D over the pixels of the window that are not full

All sensors photograph the same moment, so there are no ghosts. And the splitters waste nearly no
light: the second one gets the light that the first one reflects, and the light that it reflects
goes back through the first, which transmits most of it to the third sensor.

The merge does not average all sensors. Where the brightest sensor is not full, it has the least
noise and is used alone. Where it is full, the others replace it gradually, as they are noisier:
[Tocci11 sec. 5] has four cases.
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

# of the first and the second beam splitter
REFLECTANCES = (0.08, 0.06)
# pixels are full from this fraction of the top level on
CLIPPING_LEVEL = 0.9
# pixels
WINDOW_SIDE = 5


class State(NamedTuple):
    """The merge of the sensors from the darkest to this one.

    Attributes
    ----------
    sensor : number of the last sensor, 0 is the brightest
    E : (H, W), radiance
    case : (H, W) uint8, 1 to 4: the case of each pixel; 0 for the darkest sensor
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
    e = as_shares(e)
    rng = np.random.default_rng(rng)
    if not 8 <= bits <= 16:
        raise InputError(f"expected 8 to 16 bits, got {bits}")
    shoot_one = partial(
        assorted.shoot, full_well=full_well, read_noise=read_noise, bits=16, rng=rng
    )
    Z = np.stack([shoot_one(E, np.full(E.shape[:2], share), c) for share in e])
    step = 65535 / (2**bits - 1)
    return np.round(np.round(Z / step) * step).astype(np.uint16)


def full_share(full: Mask) -> F64:
    """Return u, the fraction of the window's pixels that are full."""
    return uniform_filter(full.astype(np.float64), WINDOW_SIDE, mode="nearest")


def predict_full(B: F64, D: F64, full: Mask) -> F64:
    """Return P = D sum B / sum D over the window's pixels that are not full [Tocci11 sec. 5].

    The paper takes the mean of the quotients B / D. The quotient of the sums is robust against a D
    near zero.
    """
    b = uniform_filter(np.where(full, 0, B), WINDOW_SIDE, mode="nearest")
    d = uniform_filter(np.where(full, 0, D), WINDOW_SIDE, mode="nearest")
    return np.where(d > 0, D * b / np.where(d > 0, d, 1), D)


def join_sensors(B: F64, D: F64, full: Mask) -> tuple[F64, NDArray[np.uint8]]:
    """Return the radiance from two sensors, and the case, 1 to 4, of each pixel [Tocci11 sec. 5].

    1  no pixel of the window is full                    B
    2  not full, but another pixel of the window is      (1 - u) B + u D
    3  full, but not all pixels of the window are        (1 - u) P + u D
    4  all pixels of the window are full                 D
    """
    u = full_share(full)
    some_full = u > 1e-9
    all_full = u > 1 - 1e-9
    bright = np.where(full, predict_full(B, D, full), B)
    mixed = (1 - u) * bright + u * D
    E = np.where(some_full, np.where(all_full, D, mixed), B)
    case = np.where(full, np.where(all_full, 4, 3), np.where(some_full, 2, 1))
    return E, case.astype(np.uint8)


def merge_steps(Z: ArrayLike, e: ArrayLike, *, full: float = CLIPPING_LEVEL) -> Iterator[State]:
    """Yield the State of the darkest sensor, and after each brighter one; parameters as of `merge`."""
    e = as_shares(e)
    stack = np.asarray(Z)
    if stack.ndim != 3 or stack.dtype not in (np.uint8, np.uint16) or len(stack) != len(e):
        raise InputError(
            f"expected pixel values ({len(e)}, H, W), an image for each fraction, "
            f"got {describe(stack)}"
        )
    if not 0 < full <= 1:
        raise InputError(f"expected a clipping level above 0 and at most 1, got {full}")
    X = stack / (levels(stack) - 1)
    darkest = len(e) - 1
    E = X[darkest] / e[darkest]
    yield State(darkest, E, np.zeros(E.shape, np.uint8))
    for j in reversed(range(darkest)):
        E, case = join_sensors(X[j] / e[j], E, X[j] >= full)
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
        Pixels are full from this fraction of the top level on.

    Returns
    -------
    E : (H, W) or (H, W, 3) float32
        A lower bound where the darkest sensor is full.

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
    """Return the shares (N,) of the light, or raise a ValueError unless they fall and sum to at most 1."""
    e = np.asarray(e, np.float64)
    is_falling = e.ndim == 1 and len(e) and np.all(e > 0) and np.all(np.diff(e) < 0)
    if not (is_falling and e.sum() < 1.001):
        raise InputError(
            f"expected positive, falling fractions of the light, with a sum of at most 1, got {e}"
        )
    return e
