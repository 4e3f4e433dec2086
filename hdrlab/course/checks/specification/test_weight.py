"""The weight of a photograph in exposure fusion: weight(F, powers) -> W (H, W)."""

import numpy as np

from hdrlab.course.checks.compare import points, same

INNER = (slice(1, -1), slice(1, -1))


def drawn(rng):
    """Return F (3, H, W)."""
    shape = (3, int(rng.integers(12, 20)), int(rng.integers(20, 30)))
    return rng.uniform(0.05, 0.95, shape).astype(np.float32)


def fused(F, powers):
    """Return W away from the border, by the sheet's formulas."""
    Y = 0.299 * F[0] + 0.587 * F[1] + 0.114 * F[2]
    C = np.abs(Y[:-2, 1:-1] + Y[2:, 1:-1] + Y[1:-1, :-2] + Y[1:-1, 2:] - 4 * Y[INNER])
    S, E = F.std(axis=0)[INNER], np.exp(-((F - 0.5) ** 2) / (2 * 0.2**2)).prod(axis=0)[INNER]
    return C ** powers[0] * S ** powers[1] * E ** powers[2]


def compared(subject, F, powers, what):
    """Compare W away from the border."""
    expected, came = fused(F, powers), np.asarray(subject.weight(F, powers))[INNER]
    same(came, expected, 2e-3 * float(expected.max()), what=what, picture=True)


@points(3)
def test_contrast_is_the_size_of_the_laplacian_of_gray(subject, rng):
    """Where is detail? Where a pixel differs from its neighbours, above or below.

    The Laplacian is what four neighbours have together, less four times the pixel.

    C = |up + down + left + right - 4 Y|, of the gray Y.
    """
    compared(subject, drawn(rng), (1, 0, 0), "W by contrast alone")


@points(3)
def test_saturation_is_the_deviation_of_red_green_and_blue(subject, rng):
    """How far are R, G and B from each other?

    Their standard deviation, in each pixel.

    The mean of three squares is a sum over 3.
    """
    compared(subject, drawn(rng), (0, 1, 0), "W by saturation alone")


@points(3)
def test_exposedness_is_a_product_over_the_channels(subject, rng):
    """Which value is exposed best? And a pixel of which one channel is clipped?

    0.5 is; a channel that is clipped makes the whole pixel count little.

    E = product of exp(-(F - 0.5)^2 / (2 0.2^2)) over R, G and B.
    """
    compared(subject, drawn(rng), (0, 0, 1), "W by exposedness alone")


@points(3)
def test_a_pixel_is_to_be_good_in_all_three(subject, rng):
    """A pixel of fine contrast may be clipped. What should it weigh?

    A product is small where one of its factors is.

    W = C^a S^b E^c with the powers (a, b, c).
    """
    for powers in ((1, 1, 1), (0.5, 2, 1)):
        compared(subject, drawn(rng), powers, f"W by powers {powers}")
