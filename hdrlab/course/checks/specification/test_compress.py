"""Checks of compress(base, low, high, contrast), Durand's compression: m (base - high)."""

import numpy as np

from hdrlab.course.checks.compare import points, same


def draw_inputs(rng):
    """Return a base, and bounds low and high that none of its pixels reaches."""
    low = float(rng.uniform(-2, 0))
    high = low + float(rng.uniform(3, 5))
    return rng.uniform(low + 0.4, high - 0.6, (20, 30)).astype(np.float32), low, high


@points(4)
def test_the_base_gets_the_requested_contrast(subject, rng):
    """The base has a range of high - low decades. It must become c = log10(contrast) decades.

    m = c / (high - low). All logarithms have the base 10.

    With a natural logarithm, c is too large by a factor of 2.3.
    """
    base, low, high = draw_inputs(rng)
    for contrast in (50.0, 10.0):
        m = np.log10(contrast) / (high - low)
        answer = subject.compress(base, low, high, contrast=contrast)
        what = "the compressed base minus its mean"
        same(answer - np.mean(answer), m * (base - base.mean()), 1e-3, what=what, picture=True)


@points(3)
def test_the_bright_end_becomes_white(subject, rng):
    """What does the bright end of your base become?

    White is 1, and its logarithm is 0.

    Subtract high from the base before you multiply by m.
    """
    base, low, high = draw_inputs(rng)
    ends = np.array([[low, high]], np.float32)
    same(
        subject.compress(ends, low, high, contrast=50.0),
        [[-np.log10(50), 0]],
        1e-3,
        what="low and high",
    )


@points(3)
def test_a_scene_of_little_contrast_is_not_stretched(subject, rng):
    """What does your m do to a scene with little contrast?

    Never stretch a scene.

    Limit m to at most 1.
    """
    base, low, high = draw_inputs(rng)
    flat = low + (base - low) / 10
    high = low + (high - low) / 10
    same(
        subject.compress(flat, low, high, contrast=50.0),
        flat - high,
        1e-3,
        what="the base",
        picture=True,
    )
