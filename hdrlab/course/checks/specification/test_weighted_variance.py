"""Checks of weighted_variance(x, w), how much the frames contradict each other: v (H, W)."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same


def draw_inputs(rng):
    """Return x (P, H, W) in which a square moved in one frame, and weights, some of them 0."""
    x = rng.uniform(-9, 3, (20, 30)) + rng.normal(0, 0.02, (4, 20, 30))
    x[int(rng.integers(0, 4)), 5:12, 8:20] += float(rng.uniform(0.5, 1.5))
    return x, rng.uniform(0, 1, x.shape) * (rng.uniform(size=x.shape) > 0.2)


@points(3)
def test_v_is_the_weighted_variance_over_the_frames(subject, rng):
    """By how much do the values of the frames differ from their mean?

    Both means are weighted: the mean of x, and the mean of the squared differences.

    v = sum w (x - m)^2 / sum w, with m = sum w x / sum w, over the frames.
    """
    x, w = draw_inputs(rng)
    w += 0.01
    v = np.sum(w * (x - np.average(x, axis=0, weights=w)) ** 2, axis=0) / w.sum(axis=0)
    same(subject.weighted_variance(x, w), v, 1e-3 * v.max(), what="v", picture=True)


@points(1, needs="test_v_is_the_weighted_variance_over_the_frames")
def test_a_single_frame_has_variance_0(subject, rng):
    """What is v if all frames but one are clipped? And if all are clipped?

    A single frame agrees with itself, so v is 0. With no frame, the formula gives 0 / 0.

    Set v to 0 where the sum of the weights is 0.
    """
    x, w = draw_inputs(rng)
    w[1:, :, ::3] = 0
    w[:, ::2, 1::3] = 0
    alone = np.count_nonzero(w, axis=0) < 2
    answer = finite(subject.weighted_variance(x, w), alone.shape, what="v")
    same(
        answer, 0 * x[0], 1e-6, what="v where at most one frame measures", picture=True, where=alone
    )


@points(1, needs="test_v_is_the_weighted_variance_over_the_frames")
def test_the_units_of_light_and_weights_cancel(subject, rng):
    """Another unit of light adds the same number to all x. What does it do to v?

    Nothing, if you subtract the mean.

    Twice the weights double the numerator and the denominator, so v must not change.
    """
    x, w = draw_inputs(rng)
    before = finite(subject.weighted_variance(x, w + 0.01), x[0].shape, what="v")
    answer = subject.weighted_variance(x + 2, 3 * w + 0.03)
    same(answer, before, 1e-3 * float(np.max(before)), what="v in other units", picture=True)
