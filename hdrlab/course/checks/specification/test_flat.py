"""Checks of flat(A, size, psi, sigma), flat patches by a chi-square test: mask (H, W)."""

import numpy as np

from hdrlab.course.checks.compare import points, same
from hdrlab.response import selection


def draw_inputs(rng, t=1, sigma=0.01):
    """Return t frames (t, H, W) of uniform surfaces, edges and a ramp, with noise."""
    y, x = np.indices((40, 60))
    E = (
        0.3
        + 0.3 * (x > rng.integers(12, 20))
        + 0.2 * (y > 25) * (x < 10)
        + 0.004 * np.maximum(x - 40, 0)
    )
    return E + rng.normal(0, sigma, (t, 40, 60))


def same_patches(subject, A, psi, **options):
    """Compare the mask with the library's, except for patches that are close to the limit."""
    low, high = (selection.flat(A, psi=psi * part, **options) for part in (1.1, 0.9))
    same(subject.flat(A, psi=psi, **options), low, 0, what="flat", picture=True, where=low == high)


# near the limit of the test, right functions differ
check_one_input = None


@points(6)
def test_a_patch_is_flat_if_noise_explains_its_variance(subject, rng):
    """A uniform surface has a variance, too: that of the noise. How large can it become?

    s times the variance of the patch, divided by that of the noise, has a chi-square distribution
    with s - 1 degrees of freedom.

    A patch of s pixels is flat if s variance / sigma^2 <= chi2.isf(psi, s - 1).
    """
    for size, psi, sigma in ((5, 0.05, 0.01), (3, 0.2, 0.02)):
        same_patches(subject, draw_inputs(rng, sigma=sigma), psi, size=size, sigma=sigma)


@points(7)
def test_the_average_of_frames_is_compared_with_its_own_noise(subject, rng):
    """With t frames, you test their average. How large is its noise?

    Its variance is that of one frame divided by t. You estimate it from the frames, with s (t - 1)
    degrees of freedom.

    Because the noise is estimated, the limit is (s - 1) f.isf(psi, s - 1, s (t - 1)).
    """
    for t in (3, int(rng.integers(4, 9))):
        same_patches(subject, draw_inputs(rng, t), 0.05, size=5, sigma=1.0)


@points(1, needs="test_a_patch_is_flat_if_noise_explains_its_variance")
def test_a_patch_cut_by_the_border_is_not_flat(subject, rng):
    """At the border, a patch is incomplete. Is it flat?

    It has too few pixels for the test.

    Return False within size // 2 pixels of the border.
    """
    inside = np.pad(np.ones((36, 56)), 2)
    answer = subject.flat(draw_inputs(rng), size=5, psi=0.05, sigma=1.0)
    same(answer, inside, 0, what="flat, for frames with little noise", picture=True)
