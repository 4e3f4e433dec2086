"""Brightness transfer from histograms: brightness_transfer(h_A, h_B) -> T (n,), NaN where not known."""

import numpy as np

from hdrlab.core.transfer import brightness_transfer
from hdrlab.course.checks.compare import finite, points, same


def drawn(rng):
    """Return the histograms of two photographs of as many pixels, B the brighter one."""
    n = int(rng.integers(50, 80))
    h = rng.integers(5, 60, (2, n)) + np.linspace(60, 0, n).astype(int) * [[1], [0]]
    h[1, -1] += h[0].sum() - h[1].sum() if h[0].sum() > h[1].sum() else 0
    return h


def sure(T, n):
    """Return where a level is known, and not so near to B's outer levels that rounding decides."""
    return (T > 0.6) & (T < n - 1.6)


@points(8)
def test_the_darkest_of_one_are_the_darkest_of_the_other(subject, rng):
    """Which level has the hundredth pixel of A, counted from the dark? And of B?

    The middle of A's step m has the rank H(m) + h(m) / 2, with H(m) the share of the pixels below
    level m.

    Find that rank on the line through B's edges: from H_B(z) at z - 1/2 to H_B(z + 1) at z + 1/2.
    """
    h_A, h_B = drawn(rng)
    T = brightness_transfer(h_A, h_B)
    came = finite(
        np.nan_to_num(np.asarray(subject.brightness_transfer(h_A, h_B), float)), T.shape, what="T"
    )
    same(came, T, 0.02, what="T", kind="curve", where=sure(T, len(T)))


@points(2)
def test_a_photograph_and_itself_have_the_same_levels(subject, rng):
    """What is T where both are one photograph?

    Each rank has the level that it had.

    T(m) = m, and not m + 1/2.
    """
    h, _ = drawn(rng)
    came, levels = subject.brightness_transfer(h, h), np.arange(1.0, len(h) - 1)
    same(came[1:-1], levels, 0.02, what="T of one photograph", kind="curve")


@points(2, needs="test_the_darkest_of_one_are_the_darkest_of_the_other")
def test_the_outer_levels_of_b_say_nothing(subject, rng):
    """How bright is a pixel of B's highest level?

    At least so bright: the level holds all that is brighter. The lowest holds all that is darker.

    T is NaN where it falls on level 0 or n - 1 of B.
    """
    h_A, h_B = drawn(rng)
    h_A[-3:] += h_A.sum() // 8
    h_B[-1] += h_B.sum() // 3
    T = brightness_transfer(h_A, h_B)
    same(subject.brightness_transfer(h_A, h_B)[-3:], T[-3:], 0.02, what="T of the brightest")


@points(1, needs="test_the_darkest_of_one_are_the_darkest_of_the_other")
def test_a_photograph_of_more_pixels_has_the_same_transfer(subject, rng):
    """B may come from a larger sensor. What does that do to ranks?

    A rank is a share of all pixels.

    Divide each histogram by its own sum.
    """
    h_A, h_B = drawn(rng)
    T, came = brightness_transfer(h_A, h_B), subject.brightness_transfer(h_A, 3 * h_B)
    same(came, T, 0.02, what="T of three times the pixels", kind="curve", where=sure(T, len(T)))
