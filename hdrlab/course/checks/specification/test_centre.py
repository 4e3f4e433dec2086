"""Checks of centre(shape, inside, share, at), a center-weighted meter: weights w (H, W)."""

import numpy as np

from hdrlab.capture import metering
from hdrlab.course.checks.compare import finite, points, same


def get_answer(subject, rng):
    """Return the student's weights and the expected ones."""
    H = int(rng.integers(20, 30))
    W = int(rng.integers(36, 48))
    shape = (H, W)
    at = float(rng.uniform(0.2, 0.3)), float(rng.uniform(0.65, 0.8))
    inside = float(rng.uniform(0.6, 0.8))
    share = int(rng.integers(120, 300)) / (H * W)
    answer = subject.centre(shape, inside=inside, share=share, at=at)
    return finite(answer, shape, what="w"), metering.centre(
        shape, inside=inside, share=share, at=at
    )


# an image needs that many pixels for a smooth weight
SMALL_INPUTS = [((24, 40), {"inside": 0.7, "share": 0.2, "at": (0.25, 0.75)})]


def check_one_input(subject, shape, **options):
    """Compare the weights and their sum, as the checks do."""
    expected = metering.centre(shape, **options)
    answer = finite(subject.centre(shape, **options), shape, what="w")
    same(answer, expected, 0.01 * expected.max(), what="w", picture=True)


@points(3)
def test_the_weights_are_a_gaussian_around_the_center(subject, rng):
    """Find the width of the Gaussian that has the fraction `inside` of its weight in the disc.

    A Gaussian that is too wide has too little weight in the disc. Find the width by bisection.

    Measure distances as fractions of the image, down and to the right. The disc is that of the spot
    meter.
    """
    for _ in range(4):
        answer, w = get_answer(subject, rng)
        same(answer / answer.max(), w / w.max(), 0.01, what="w / max(w)", picture=True)


@points(1, needs="test_the_weights_are_a_gaussian_around_the_center")
def test_the_weights_sum_to_one(subject, rng):
    """What does the meter read for an image that is 0.5 everywhere?

    It reads 0.5 if the weights sum to 1.

    Divide w by its sum.
    """
    answer, _ = get_answer(subject, rng)
    same(np.sum(answer), 1, 1e-3, what="the sum of w")
