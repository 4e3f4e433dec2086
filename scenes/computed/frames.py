"""Pictures hung on a wall, in their frames.

rho   reflectance (3, N); u, v  places (N,), w  width of a pixel (N,), all in metres
"""

import numpy as np

from scenes.computed.textures import Points, cover, look_up, rgb, within


def margin(u: Points, v: Points, width: float, height: float) -> Points:
    """Return how far (u, v) lies from the sides of a rectangle; below 0 outside."""
    return np.minimum(np.minimum(u, width - u), np.minimum(v, height - v))


def hang(
    rho: Points, name: str, u: Points, v: Points, width: float, height: float, w: Points
) -> Points:
    """Return `rho` with a framed picture on it; u, v from the picture's upper left corner, all in metres."""
    inside = margin(u, v, width, height)
    at = np.flatnonzero(inside > -w)
    picture = np.zeros((3, len(u)), np.float32)
    picture[:, at] = look_up(name, u[at] / width, v[at] / height, w[at] / width)
    framed = cover(rho, within(inside + 0.045, w), rgb(0.05, 0.03, 0.02))
    return cover(framed, within(inside, w), picture)
