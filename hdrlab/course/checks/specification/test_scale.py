"""Chiu's scale: scale(L, headroom, sigma) -> s (H, W), so that s L is the picture."""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.course.checks.compare import finite, points, require, same

SIGMA = 4.0
INNER = (slice(16, -16), slice(16, -16))  # away from the border, where a blur may do this or that


def drawn(rng, shape=(60, 76)):
    """Return luminance without hot pixels: soft light."""
    lL = gaussian_filter(rng.standard_normal(shape), 5)
    return np.exp(0.7 * lL / lL.std()).astype(np.float32)


def asked(subject, L, k=8.0):
    """Return s (H, W)."""
    return finite(subject.scale(L, headroom=k, sigma=SIGMA), L.shape, what="s").astype(float)


def test_every_pixel_has_a_scale_above_0(subject, rng):
    """A scale for each pixel: the shape of L.

    A luminance that is blurred is above 0, and so is its inverse.

    Nothing in it is NaN or infinite.
    """
    s = asked(subject, drawn(rng))
    require((s > 0).all(), f"s: expected scales above 0, got {s.min():.3g}", came=s)


@points(2)
def test_an_even_wall_is_shown_at_one_over_k(subject, rng):
    """An even wall of luminance L: how bright should it be shown?

    s L = 1 / k: the neighbourhood comes out as one k-th of white.

    s = 1 / (k blur(L)): no further factor L, which is a misprint.
    """
    for _ in range(2):
        level, k = float(10 ** rng.uniform(-2, 3)), float(rng.uniform(2, 16))
        L = np.full((40, 40), level, np.float32)
        same(asked(subject, L, k) * L, np.full(L.shape, 1 / k), 0.01 / k, what="s L", picture=True)


@points(6)
def test_it_is_one_over_k_times_the_blur(subject, rng):
    """Blur first, and divide then: the mean of 1 / L is another thing.

    A Gaussian of `sigma` pixels.

    s = 1 / (k blur(L)).
    """
    L = drawn(rng)
    truth = 1 / (8 * gaussian_filter(L.astype(float), SIGMA))
    shares = (asked(subject, L) / truth)[INNER]
    same(shares, np.ones(shares.shape), 0.08, what="s k blur(L)", picture=True)


@points(2, needs="test_it_is_one_over_k_times_the_blur")
def test_the_unit_of_luminance_cancels_in_the_picture(subject, rng):
    """Ten times the light in the whole scene: what becomes of s, and what of s L?

    The scale is the inverse of a luminance.

    s of 10 L is s / 10.
    """
    L = drawn(rng)
    one, ten = (asked(subject, light) * light for light in (L, np.float32(10) * L))
    same(ten, one, 0.01 * float(one.max()), what="s L with ten times the light", picture=True)
