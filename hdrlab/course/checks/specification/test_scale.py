"""Checks of scale(L, headroom, sigma), Chiu's scale: s (H, W), so that s L is the tone-mapped
image.
"""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.course.checks.compare import finite, points, require, same

SIGMA = 4.0
INNER = (slice(16, -16), slice(16, -16))  # away from the border, where blurs differ


def draw_inputs(rng, shape=(60, 76)):
    """Return smooth luminance without hot pixels."""
    lL = gaussian_filter(rng.standard_normal(shape), 5)
    return np.exp(0.7 * lL / lL.std()).astype(np.float32)


def get_answer(subject, L, k=8.0):
    """Return s (H, W)."""
    return finite(subject.scale(L, headroom=k, sigma=SIGMA), L.shape, what="s").astype(float)


def draw_pixel(value):
    """Return an image of ones with one other value in its middle, far from the borders."""
    image = np.ones((9, 9))
    image[4, 4] = value
    return image


# near a border, right blurs differ
SMALL_INPUTS = [
    (np.full((1, 1), 1.0), {"headroom": 8.0, "sigma": 1.0}),
    (np.full((1, 1), 2.0), {"headroom": 8.0, "sigma": 1.0}),
    (draw_pixel(9.0), {"headroom": 8.0, "sigma": 1.0}),
]


def test_every_pixel_has_a_scale_above_0(subject, rng):
    """Return one scale per pixel, with the shape of L.

    The blurred luminance is above 0, and so is its inverse.

    No value may be NaN or infinite.
    """
    s = get_answer(subject, draw_inputs(rng))
    require((s > 0).all(), f"s: expected scales above 0, got {s.min():.3g}", answer=s)


@points(2)
def test_a_uniform_image_is_shown_at_one_over_k(subject, rng):
    """How bright should a uniform wall of luminance L become?

    s L = 1 / k: the local average becomes 1 / k of white.

    s = 1 / (k blur(L)). The extra factor L in the paper is a misprint.
    """
    for _ in range(2):
        level = float(10 ** rng.uniform(-2, 3))
        k = float(rng.uniform(2, 16))
        L = np.full((40, 40), level, np.float32)
        same(
            get_answer(subject, L, k) * L,
            np.full(L.shape, 1 / k),
            0.01 / k,
            what="s L",
            picture=True,
        )


@points(6)
def test_it_is_one_over_k_times_the_blur(subject, rng):
    """Blur L first, and divide afterwards. The blur of 1 / L is something else.

    Use a Gaussian with a standard deviation of `sigma` pixels.

    s = 1 / (k blur(L)).
    """
    L = draw_inputs(rng)
    truth = 1 / (8 * gaussian_filter(L.astype(float), SIGMA))
    shares = (get_answer(subject, L) / truth)[INNER]
    same(shares, np.ones(shares.shape), 0.08, what="s k blur(L)", picture=True)


@points(2, needs="test_it_is_one_over_k_times_the_blur")
def test_the_unit_of_luminance_cancels(subject, rng):
    """Make the scene ten times as bright. What happens to s, and to s L?

    s is proportional to 1 / L, so s L does not change.

    s of 10 L must be s / 10.
    """
    L = draw_inputs(rng)
    brighter = np.float32(10) * L
    sL = get_answer(subject, L) * L
    sL_brighter = get_answer(subject, brighter) * brighter
    same(sL_brighter, sL, 0.01 * float(sL.max()), what="s L with ten times the light", picture=True)
