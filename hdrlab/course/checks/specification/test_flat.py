"""Flat patches by chi-square: flat(A, size, psi, sigma) -> mask (H, W)."""

import numpy as np

from hdrlab.course.checks.compare import points, same
from hdrlab.response import selection


def drawn(rng, t=1, sigma=0.01):
    """Return t frames (t, H, W) of even surfaces, edges and a ramp, with noise."""
    y, x = np.indices((40, 60))
    E = (
        0.3
        + 0.3 * (x > rng.integers(12, 20))
        + 0.2 * (y > 25) * (x < 10)
        + 0.004 * np.maximum(x - 40, 0)
    )
    return E + rng.normal(0, sigma, (t, 40, 60))


def same_patches(subject, A, psi, **knobs):
    """Compare the mask with the library's: but for patches that just pass, or just do not."""
    low, high = (selection.flat(A, psi=psi * part, **knobs) for part in (1.1, 0.9))
    same(subject.flat(A, psi=psi, **knobs), low, 0, what="flat", picture=True, where=low == high)


@points(6)
def test_a_patch_is_flat_where_noise_explains_its_spread(subject, rng):
    """An even surface has a spread, too: that of the noise. How large may it be?

    s times its variance, over that of the noise, is chi-square of s - 1 degrees of freedom.

    s spread / sigma^2 <= chi2.isf(psi, s - 1), s the number of pixels of a patch.
    """
    for size, psi, sigma in ((5, 0.05, 0.01), (3, 0.2, 0.02)):
        same_patches(subject, drawn(rng, sigma=sigma), psi, size=size, sigma=sigma)


@points(7)
def test_the_average_of_frames_is_held_against_its_own_noise(subject, rng):
    """Of t frames you have the average. How large is its noise?

    Its variance is that of one frame over t; and that is estimated, with s (t - 1) degrees of
    freedom.

    Against an estimate the limit is (s - 1) f.isf(psi, s - 1, s (t - 1)).
    """
    for t in (3, int(rng.integers(4, 9))):
        same_patches(subject, drawn(rng, t), 0.05, size=5, sigma=1.0)


@points(1, needs="test_a_patch_is_flat_where_noise_explains_its_spread")
def test_a_patch_that_is_cut_is_not_flat(subject, rng):
    """At the edge a patch is not whole. Is it flat?

    Nobody can say.

    False within size // 2 pixels of the edge.
    """
    inside, came = (
        np.pad(np.ones((36, 56)), 2),
        subject.flat(drawn(rng), size=5, psi=0.05, sigma=1.0),
    )
    same(came, inside, 0, what="flat, of frames with less than their noise", picture=True)
