"""Checks of weight(F, powers), the weight of an image in exposure fusion: W (H, W)."""

import numpy as np

from hdrlab.course.checks.compare import points, same

INNER = (slice(1, -1), slice(1, -1))


def draw_inputs(rng):
    """Return F (3, H, W)."""
    shape = (3, int(rng.integers(12, 20)), int(rng.integers(20, 30)))
    return rng.uniform(0.05, 0.95, shape).astype(np.float32)


def fused(F, powers):
    """Return W away from the border, computed with the formulas of the assignment."""
    Y = 0.299 * F[0] + 0.587 * F[1] + 0.114 * F[2]
    C = np.abs(Y[:-2, 1:-1] + Y[2:, 1:-1] + Y[1:-1, :-2] + Y[1:-1, 2:] - 4 * Y[INNER])
    S = F.std(axis=0)[INNER]
    E = np.exp(-((F - 0.5) ** 2) / (2 * 0.2**2)).prod(axis=0)[INNER]
    return C ** powers[0] * S ** powers[1] * E ** powers[2]


def compared(subject, F, powers, what):
    """Compare W away from the border."""
    expected = fused(F, powers)
    answer = np.asarray(subject.weight(F, powers))[INNER]
    same(answer, expected, 2e-3 * float(expected.max()), what=what, picture=True)


def is_valid_input(F, powers=(1, 1, 1)):
    """Return whether the image has three channels, and pixels that are not at the border."""
    return len(F) == 3 and min(F.shape[1:]) >= 3


@points(3)
def test_contrast_is_the_absolute_laplacian_of_gray(subject, rng):
    """Detail is where a pixel differs from its neighbors, above or below.

    The Laplacian is the sum of four neighbors minus four times the pixel.

    C = |up + down + left + right - 4 Y|, of the gray Y.
    """
    compared(subject, draw_inputs(rng), (1, 0, 0), "W from contrast alone")


@points(3)
def test_saturation_is_the_standard_deviation_of_the_channels(subject, rng):
    """How much do R, G and B differ from each other?

    Use their standard deviation in each pixel.

    Divide the sum of the three squared differences by 3.
    """
    compared(subject, draw_inputs(rng), (0, 1, 0), "W from saturation alone")


@points(3)
def test_exposedness_is_a_product_over_the_channels(subject, rng):
    """Which value is exposed best? And what if one channel is clipped?

    0.5 is best. One clipped channel must make the weight of the whole pixel small.

    E = product of exp(-(F - 0.5)^2 / (2 0.2^2)) over R, G and B.
    """
    compared(subject, draw_inputs(rng), (0, 0, 1), "W from exposedness alone")


@points(3)
def test_the_weight_is_the_product_of_all_three_measures(subject, rng):
    """A pixel with high contrast can be clipped. What should its weight be?

    A product is small if one of its factors is small.

    W = C^a S^b E^c with the powers (a, b, c).
    """
    for powers in ((1, 1, 1), (0.5, 2, 1)):
        compared(subject, draw_inputs(rng), powers, f"W with powers {powers}")
