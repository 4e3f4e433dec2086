"""A centre-weighted meter: centre(shape, inside, share, at) -> w (H, W)."""

import numpy as np

from hdrlab.capture import metering
from hdrlab.course.checks.compare import finite, points, same


def asked(subject, rng):
    """Return what came, what was expected, and where the middle is."""
    H, W = shape = int(rng.integers(20, 30)), int(rng.integers(36, 48))
    at = float(rng.uniform(0.2, 0.3)), float(rng.uniform(0.65, 0.8))
    inside, share = float(rng.uniform(0.6, 0.8)), int(rng.integers(120, 300)) / (H * W)
    came = subject.centre(shape, inside=inside, share=share, at=at)
    return finite(came, shape, what="w"), metering.centre(shape, inside=inside, share=share, at=at)


@points(3)
def test_most_of_the_weight_lies_in_the_middle_and_fades_like_a_gaussian(subject, rng):
    """How wide is a Gaussian of which `inside` lies in the disc?

    Too wide, and too little lies in it: halve the interval.

    The distance is in parts of the picture, down and right; the disc is that of the spot meter.
    """
    for _ in range(4):
        came, w = asked(subject, rng)
        same(came / came.max(), w / w.max(), 0.01, what="w, in shares of the largest", picture=True)


@points(1, needs="test_most_of_the_weight_lies_in_the_middle_and_fades_like_a_gaussian")
def test_all_weights_together_are_one(subject, rng):
    """Which is the reading of a picture that is 0.5 everywhere?

    0.5, if the weights add up to 1.

    Divide w by its sum.
    """
    came, _ = asked(subject, rng)
    same(np.sum(came), 1, 1e-3, what="the sum of w")
