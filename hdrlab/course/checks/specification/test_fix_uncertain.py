"""Durand's uncertain pixels: fix_uncertain(mean, k, sigma_s) -> base (H, W)."""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.course.checks.compare import points, same
from hdrlab.tonemap import durand

INNER = np.s_[10:-10, 10:-10]


def drawn(rng):
    """Return a mean, with pixels unlike their neighbourhood, and k of each, which is small there."""
    mean = gaussian_filter(rng.standard_normal((60, 70)), 8) * 20
    lone = rng.uniform(size=mean.shape) < 0.05
    k = np.where(lone, rng.uniform(1, 12, mean.shape), rng.uniform(150, 300, mean.shape))
    return (mean + 2 * lone).astype(np.float32), k.astype(np.float32)


@points(6)
def test_a_base_that_rests_on_few_pixels_is_that_of_its_neighbourhood(subject, rng):
    """A pixel unlike all around it is its own base. What is a better one?

    The blurred mean, the more the fewer pixels it rests on: u mean + (1 - u) blur.

    u = ln k / ln(root of 2 pi sigma_s^2), from 0 to 1, and the blur is a Gaussian of 2 pixels.
    """
    for sigma_s in (6.0, float(rng.uniform(4, 9))):
        mean, k = drawn(rng)
        base = durand.fix_uncertain(mean, k, sigma_s=sigma_s)
        came = subject.fix_uncertain(mean, k, sigma_s=sigma_s)
        inner = np.zeros(base.shape, bool)
        inner[INNER] = True
        same(came, base, 0.02, what="the base", picture=True, where=inner)


@points(2, needs="test_a_base_that_rests_on_few_pixels_is_that_of_its_neighbourhood")
def test_a_base_that_rests_on_many_stays(subject, rng):
    """And a pixel with many of its kind around it?

    Its u is 1 from the root of 2 pi sigma_s^2 pixels on, and not above.

    Clip u at 1: a larger one would sharpen the base.
    """
    mean, k = drawn(rng)
    came = subject.fix_uncertain(mean, k, sigma_s=6.0)
    same(came, mean, 1e-4, what="the base of certain pixels", picture=True, where=k > 150)


@points(2)
def test_a_pixel_alone_has_no_say(subject, rng):
    """What is u of a pixel that only itself is like, k = 1?

    ln 1 = 0: its base is the blur alone, and below 1 it is no less.

    Clip u at 0.
    """
    mean, k = drawn(rng)
    k[...] = rng.uniform(0.5, 1, k.shape)
    smooth = gaussian_filter(mean.astype(np.float64), durand.NEAR)[INNER]
    same(
        subject.fix_uncertain(mean, k, sigma_s=6.0)[INNER],
        smooth,
        0.02,
        what="the base",
        picture=True,
    )
