"""Checks of fix_uncertain(mean, k, sigma_s), Durand's uncertain pixels: base (H, W)."""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.course.checks.compare import points, same
from hdrlab.tonemap import durand

INNER = np.s_[10:-10, 10:-10]


def draw_inputs(rng):
    """Return a mean in which some pixels differ from their neighborhood, and k, which is small
    at these pixels.
    """
    mean = gaussian_filter(rng.standard_normal((60, 70)), 8) * 20
    lone = rng.uniform(size=mean.shape) < 0.05
    k = np.where(lone, rng.uniform(1, 12, mean.shape), rng.uniform(150, 300, mean.shape))
    return (mean + 2 * lone).astype(np.float32), k.astype(np.float32)


def draw_pixel(value):
    """Return an image of zeros with one other value in its middle, far from the borders."""
    image = np.zeros((17, 17))
    image[8, 8] = value
    return image


# near a border, right blurs differ
SMALL_INPUTS = [
    (draw_pixel(1.0), np.full((17, 17), k), {"sigma_s": sigma_s})
    for sigma_s in (2.0, 6.0)
    for k in (3.0, 0.5, 20.0)
]


def check_one_input(subject, mean, k, **options):
    """Compare the base. Right blurs of one pixel differ by 0.0005."""
    base = durand.fix_uncertain(mean, k, **options)
    same(subject.fix_uncertain(mean, k, **options), base, 0.002, what="the base")


@points(6)
def test_uncertain_pixels_are_blended_with_the_blurred_mean(subject, rng):
    """Few neighbors are similar to such a pixel, so its mean is uncertain. Which value is better?

    Blend it with the blurred mean: u mean + (1 - u) blur. A pixel with a smaller k has a smaller u.

    u = ln k / ln(sqrt(2 pi sigma_s^2)), clipped to 0 ... 1. The blur is a Gaussian with a sigma of
    2 pixels.
    """
    for sigma_s in (6.0, float(rng.uniform(4, 9))):
        mean, k = draw_inputs(rng)
        base = durand.fix_uncertain(mean, k, sigma_s=sigma_s)
        answer = subject.fix_uncertain(mean, k, sigma_s=sigma_s)
        inner = np.zeros(base.shape, bool)
        inner[INNER] = True
        same(answer, base, 0.02, what="the base", picture=True, where=inner)


@points(2, needs="test_uncertain_pixels_are_blended_with_the_blurred_mean")
def test_certain_pixels_keep_their_mean(subject, rng):
    """What is u of a pixel with many similar neighbors?

    u reaches 1 at k = sqrt(2 pi sigma_s^2), and must not go above 1.

    Clip u at 1. A larger u would sharpen the base.
    """
    mean, k = draw_inputs(rng)
    answer = subject.fix_uncertain(mean, k, sigma_s=6.0)
    same(answer, mean, 1e-4, what="the base of certain pixels", picture=True, where=k > 150)


@points(2)
def test_a_pixel_without_similar_neighbors_takes_the_blur(subject, rng):
    """What is u of a pixel that no neighbor is similar to, with k = 1?

    ln 1 = 0, so its base is the blur alone. For k below 1 it is the blur, too.

    Clip u at 0.
    """
    mean, k = draw_inputs(rng)
    k[...] = rng.uniform(0.5, 1, k.shape)
    smooth = gaussian_filter(mean.astype(np.float64), durand.UNCERTAIN_SIGMA)[INNER]
    same(
        subject.fix_uncertain(mean, k, sigma_s=6.0)[INNER],
        smooth,
        0.02,
        what="the base",
        picture=True,
    )
