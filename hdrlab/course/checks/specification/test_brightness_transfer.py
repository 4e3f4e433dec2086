"""Checks of brightness_transfer(h_A, h_B), from histograms: T (n,), NaN where T is not known."""

import numpy as np

from hdrlab.core.transfer import brightness_transfer
from hdrlab.course.checks.compare import finite, points, same


def draw_inputs(rng):
    """Return the histograms of two photos with equally many pixels, B the brighter one."""
    n = int(rng.integers(50, 80))
    h = rng.integers(5, 60, (2, n)) + np.linspace(60, 0, n).astype(int) * [[1], [0]]
    h[1, -1] += h[0].sum() - h[1].sum() if h[0].sum() > h[1].sum() else 0
    return h


def sure(T, n):
    """Return where T is known and far enough from B's end levels that rounding does not matter."""
    return (T > 0.6) & (T < n - 1.6)


def on_the_sheet(T):
    """Return T (n,), the library's, as the sheet defines it."""
    return T


def is_valid_input(h_A, h_B):
    """Return whether both photos have enough levels to interpolate between."""
    return len(h_A) == len(h_B) >= 4


@points(8)
def test_pixels_of_equal_rank_correspond(subject, rng):
    """Sort the pixels of A and of B from dark to bright. The hundredth pixel of A corresponds to
    the hundredth pixel of B.

    The rank of pixel value m in A is H(m) + h(m) / 2, where H(m) is the fraction of pixels below
    pixel value m.

    Find this rank in B by linear interpolation between the edges of the pixel values: H_B(z) at z -
    1/2 and H_B(z + 1) at z + 1/2.
    """
    h_A, h_B = draw_inputs(rng)
    T = brightness_transfer(h_A, h_B)
    answer = finite(
        np.nan_to_num(np.asarray(subject.brightness_transfer(h_A, h_B), float)), T.shape, what="T"
    )
    same(answer, on_the_sheet(T), 0.02, what="T", kind="curve", where=sure(T, len(T)))


@points(2)
def test_a_photo_compared_with_itself_keeps_its_levels(subject, rng):
    """What is T if A and B are the same photo?

    Each rank keeps its pixel value.

    T(m) = m, not m + 1/2.
    """
    h, _ = draw_inputs(rng)
    answer = subject.brightness_transfer(h, h)
    levels = on_the_sheet(np.arange(float(len(h))))
    same(answer[1:-1], levels[1:-1], 0.02, what="T of one photograph", kind="curve")


@points(2, needs="test_pixels_of_equal_rank_correspond")
def test_T_is_not_known_at_the_end_levels_of_b(subject, rng):
    """How bright is a pixel of B's highest value?

    It can have any brightness from that pixel value up, because brighter pixels are clipped to it.
    The same holds for the lowest pixel value and darker pixels.

    Set T to NaN where it falls on pixel value 0 or n - 1 of B.
    """
    h_A, h_B = draw_inputs(rng)
    h_A[-3:] += h_A.sum() // 8
    h_B[-1] += h_B.sum() // 3
    T = brightness_transfer(h_A, h_B)
    T = on_the_sheet(T)
    same(subject.brightness_transfer(h_A, h_B)[-3:], T[-3:], 0.02, what="T of the brightest")
    T = brightness_transfer(h_A[::-1], h_B[::-1])
    answer = subject.brightness_transfer(h_A[::-1], h_B[::-1])
    same(answer[:3], on_the_sheet(T)[:3], 0.02, what="T of the darkest")


@points(1, needs="test_pixels_of_equal_rank_correspond")
def test_the_number_of_pixels_does_not_matter(subject, rng):
    """B can come from a larger sensor. What does this do to your ranks?

    A rank is a fraction of all pixels.

    Divide each histogram by its own sum.
    """
    h_A, h_B = draw_inputs(rng)
    T = brightness_transfer(h_A, h_B)
    answer = subject.brightness_transfer(h_A, 3 * h_B)
    expected = on_the_sheet(T)
    where = sure(T, len(T))
    same(answer, expected, 0.02, what="T of three times the pixels", kind="curve", where=where)
