"""Photographs as values that can be compared after converting them to a common exposure.

Z      photographs         (P, H, W[, 3]) levels;  t  (P,) times, s;  g  (n[, 3]) ln exposure of each level
X      exposure            share of a full pixel, exp g(Z) / exp g(n - 1), 0 to 1
v      value               X^(1 / 2.2), (H, W, C) float32: equal differences look about equal
H      radiance            (H, W, C), in the unit of g per second
full   exp g(n - 1)        (C,), exposure of a full pixel
noise  (H, W, C)           change of the value for a change of one level
"""

from dataclasses import dataclass

import numpy as np

from hdrlab.core.arrays import (
    F32,
    F64,
    Array,
    ArrayLike,
    Mask,
    as_response,
    as_stack,
    as_times,
    levels,
)
from hdrlab.core.optional import skimage_transform as transform

GAMMA = 2.2
# levels
LEVEL_TOLERANCE = 3
# of the top level: above it a pixel may have been full, as in `radiance.merge`
CLIPPING_LEVEL = 0.98


@dataclass(frozen=True)
class Values:
    """Photographs as values.

    Attributes
    ----------
    v : (P, H, W, C)
    z : (P, H, W, C), levels from 0 to 1
    noise : (P, H, W, C)
    clipped : (P, H, W, C) bool
    t : (P,), seconds
    full : (C,)
    """

    v: F32
    z: F32
    noise: F32
    clipped: Mask
    t: F64
    full: F32


def radiance(v: F32, t: float, full: F32) -> F32:
    """Return h(v) = v^2.2 full / t."""
    return v ** np.float32(GAMMA) * full / np.float32(t)


def expose(H: F32, t: float, full: F32) -> F32:
    """Return l(H) = min(H t / full, 1)^(1 / 2.2)."""
    return np.minimum(H * (np.float32(t) / full), 1) ** np.float32(1 / GAMMA)


def boost(v: F32, ratio: float) -> F32:
    """Return l(h(v)) for an exposure `ratio` times as long, min(ratio^(1 / 2.2) v, 1) [Kang03 sec. 4].

    Examples
    --------
    >>> boost(np.float32([0.25, 0.8]), 4).round(3)
    array([0.469, 1.   ], dtype=float32)
    """
    return np.minimum(v * np.float32(ratio ** (1 / GAMMA)), 1)


def consistent_range(v: F32, noise: F32, clipped: Mask, t: float, full: F32) -> tuple[F32, F32]:
    """Return the lowest and highest radiance that is consistent with a photograph, within 3 levels.

    A clipped pixel is a lower bound, and has no upper one.
    """
    tolerance = np.float32(LEVEL_TOLERANCE) * noise
    low = radiance(np.where(clipped, v, np.maximum(v - tolerance, 0)), t, full)
    high = np.where(clipped, np.float32(np.inf), radiance(v + tolerance, t, full))
    return low, high


def resize_picture(picture: Array, shape: tuple[int, int]) -> F32:
    """Return a picture (h, w, C) at another size: blurred first, where it is made smaller."""
    if picture.shape[:2] == shape:
        return picture.astype(np.float32)
    smaller = shape[0] < picture.shape[0]
    return transform.resize(picture.astype(np.float32), shape, order=1, anti_aliasing=smaller)


def look_up_levels(table: F32, Z: Array) -> F32:
    """Return table[Z] (P, H, W, C), each channel by its own column."""
    return np.stack([table[Z[..., c], c] for c in range(Z.shape[-1])], axis=-1)


def as_values(images: ArrayLike, times: ArrayLike, g: ArrayLike) -> Values:
    """Return photographs as Values, checked, in their order."""
    stack = as_stack(images)
    t = as_times(times, len(stack))
    n = levels(stack)
    Z = stack.reshape(*stack.shape[:3], -1)
    table = as_response(g, n, Z.shape[-1])
    v = np.exp((table - table[-1]) / GAMMA).astype(np.float32)
    z = (Z / (n - 1)).astype(np.float32)
    full = np.broadcast_to(np.exp(table[-1]).astype(np.float32), Z.shape[-1:])
    return Values(
        v=look_up_levels(v, Z),
        z=z,
        noise=look_up_levels(np.gradient(v, axis=0), Z),
        clipped=z > CLIPPING_LEVEL,
        t=t,
        full=full,
    )
