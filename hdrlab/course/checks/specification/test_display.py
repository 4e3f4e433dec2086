"""Checks of display(Lm, adaptation, white), Reinhard's curve: Ld. The adaptation is Lm or its
local average.
"""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same


def draw_inputs(rng):
    return np.exp(1.5 * rng.standard_normal((20, 30)) - 1).astype(np.float32)


@points(3)
def test_without_a_white_Ld_is_Lm_over_one_plus_adaptation(subject, rng):
    """Without a white, Ld stays below 1, and Lm = 1 becomes 0.5.

    Ld = Lm / (1 + adaptation).

    For the global operator, the adaptation is Lm itself.
    """
    Lm = draw_inputs(rng)
    same(subject.display(Lm, Lm), Lm / (1 + Lm), 1e-4, what="Ld", picture=True)


@points(3)
def test_white_becomes_1_and_brighter_pixels_are_clipped(subject, rng):
    """Put Lm = white into your formula: the result must be 1.

    The factor (1 + Lm / white^2) brings white to 1.

    Use the square of white, and clip larger values at 1.
    """
    Lm = draw_inputs(rng)
    white = float(rng.uniform(1.5, 6))
    Lm[0, :5] = white * np.array([1, 1.5, 2, 10, 100])
    expected = np.minimum(Lm * (1 + Lm / white**2) / (1 + Lm), 1)
    same(subject.display(Lm, Lm, white), expected, 1e-4, what="Ld", picture=True)


@points(2)
def test_the_neighborhood_goes_below_the_fraction_bar(subject, rng):
    """Dodging and burning: which brightness stands in the denominator?

    The denominator has the neighborhood, and the numerator has the pixel.

    Ld = Lm / (1 + adaptation), where adaptation is the second argument.
    """
    Lm = draw_inputs(rng)
    around = np.full_like(Lm, np.exp(rng.uniform(-1, 1)))
    same(
        subject.display(Lm, around), np.minimum(Lm / (1 + around), 1), 1e-4, what="Ld", picture=True
    )
    finite(subject.display(Lm * 1e6, around), Lm.shape, what="Ld")


@points(2)
def test_white_and_the_neighborhood_work_together(subject, rng):
    """A pixel is brighter than white, and its neighborhood is brighter still. Is it white?

    Not if the formula says less than 1. Only values above 1 are clipped.

    Compute the whole formula with both arguments, and take the minimum of it and 1.
    """
    Lm = draw_inputs(rng)
    around = np.exp(1.5 * rng.standard_normal(Lm.shape)).astype(np.float32)
    white = float(rng.uniform(1.5, 4))
    Lm[:3] = white * rng.uniform(1, 1.5, Lm[:3].shape)
    around[:3] = white * rng.uniform(3, 5, Lm[:3].shape)
    expected = np.minimum(Lm * (1 + Lm / white**2) / (1 + around), 1)
    same(subject.display(Lm, around, white), expected, 1e-4, what="Ld", picture=True)
