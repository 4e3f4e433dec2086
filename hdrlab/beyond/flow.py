"""Optical flow between frames, and pictures warped along it (Kang et al., SIGGRAPH 2003, sec. 4).

a, b   pictures   (H, W) float32, boosted to one exposure, values of `ldr_values`
u      flow       (2, H, W), pixels down and right: a(p) is b(p + u(p))
f      any map    (H, W[, C])

The flow is found coarse to fine, by scikit-image's TV-L1: a pan of many pixels is a small one at
the coarsest level. The paper fits a global motion first and lets each region deviate from it; the
pyramid does the same.
"""

from collections.abc import Callable

import numpy as np
from scipy.ndimage import map_coordinates

from hdrlab.core.arrays import F32, Mask
from hdrlab.core.optional import skimage_registration

Flow = Callable[[F32, F32], F32]


def tvl1(a: F32, b: F32) -> F32:
    """Return u for which a(p) is b(p + u(p)); 0 where a picture is too small.

    Examples
    --------
    >>> ramp = np.float32(np.hypot(*np.mgrid[-16:16, -16:16]) / 24)
    >>> tvl1(ramp, np.roll(ramp, 2, axis=1))[:, 8:-8, 8:-8].mean(axis=(1, 2)).round(1) + 0.0
    array([0., 2.], dtype=float32)
    """
    if min(a.shape) < 16:
        return np.zeros((2, *a.shape), np.float32)
    return skimage_registration.optical_flow_tvl1(a, b).astype(np.float32)


def warp(f: F32, u: F32) -> F32:
    """Return f(p + u(p)), linear between pixels; beyond the edge it is the edge's."""
    places = np.indices(u.shape[1:]) + u
    planes = f.reshape(*f.shape[:2], -1).astype(np.float32)
    channels = np.moveaxis(planes, -1, 0)
    warped = [map_coordinates(plane, places, order=1, mode="nearest") for plane in channels]
    return np.stack(warped, axis=-1).reshape(f.shape)


def lands_inside(u: F32) -> Mask:
    """Return where p + u(p) lies in the picture, (H, W)."""
    places = np.indices(u.shape[1:]) + u
    ends = np.array(u.shape[1:]).reshape(2, 1, 1) - 1
    return np.all((places >= 0) & (places <= ends), axis=0)


def halve_flow(u: F32) -> tuple[F32, F32]:
    """Return the flows from the moment half-way between a and b to a and to b.

    u belongs to the pixels of a. Two iterations of u(p - u / 2) give the flow at the pixels of the
    moment half-way.
    """
    half = (u / 2).astype(np.float32)
    for _ in range(2):
        moved = np.stack([warp(component, -half) for component in u])
        half = (moved / 2).astype(np.float32)
    return -half, half
