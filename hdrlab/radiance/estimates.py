"""Four ways to make one radiance of what several frames say of a pixel.

X   exposure        (n,), f^-1 of each level, exp(g)
g   ln f^-1         (n,)
w   weights         (n,), how far to trust a level
t   exposure time   seconds

Each is a quotient of two sums over the frames, sum_j a_j(Z_j) / sum_j b_j(Z_j), and each function returns the
terms a and b of one frame, as tables over its levels. Where the frames agree, so do the four.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]
Terms = Callable[[Float, Float, float], tuple[Float, Float]]


def log_mean(w: Float, g: Float, t: float) -> tuple[Float, Float]:
    """Return the terms of ln E = sum w (g - ln t) / sum w [Debevec97 eq. 6]."""
    return w * (g - np.log(t)), w


def likelihood(w: Float, g: Float, t: float) -> tuple[Float, Float]:
    """Return the terms of E = sum w X t / sum w t^2 [Robertson03 eq. 8]: noise of one size in every frame."""
    return w * np.exp(g) * t, w * t**2


def frame_mean(w: Float, g: Float, t: float) -> tuple[Float, Float]:
    """Return the terms of E = sum w (X / t) / sum w [Battiato08 eq. 1.20]: the mean of all answers.

    Examples
    --------
    >>> w, g = np.ones(256), np.log(np.arange(1, 257) / 256)
    >>> (a1, b1), (a2, b2) = frame_mean(w, g, 1.0), frame_mean(w, g, 2.0)
    >>> float((a1[63] + a2[127]) / (b1[63] + b2[127]))  # a quarter in a second is a half in two
    0.25
    """
    return w * np.exp(g) / t, w


def shot_noise(w: Float, g: Float, t: float) -> tuple[Float, Float]:
    """Return the terms of E = sum w X / sum w t: all light over all time, best where photons are noise."""
    return w * np.exp(g), w * t


METHODS: dict[str, Terms] = {
    "log": log_mean,
    "likelihood": likelihood,
    "mean": frame_mean,
    "shot": shot_noise,
}
