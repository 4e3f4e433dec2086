"""Reinhard's curve: display(Lm, adaptation, white) -> Ld; the adaptation is Lm or its neighbourhood."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same


def drawn(rng):
    return np.exp(1.5 * rng.standard_normal((20, 30)) - 1).astype(np.float32)


@points(3)
def test_without_a_white_it_is_lm_over_one_plus_adaptation(subject, rng):
    """Without a white, Ld stays below 1, and a Lm of 1 becomes a half.

    Ld = Lm / (1 + adaptation).

    For the global operator the adaptation is Lm itself.
    """
    Lm = drawn(rng)
    same(subject.display(Lm, Lm), Lm / (1 + Lm), 1e-4, what="Ld", picture=True)


@points(3)
def test_white_becomes_1_and_what_is_brighter_stays_there(subject, rng):
    """Put Lm = white into your formula: it should come out as 1.

    The factor (1 + Lm / white^2) brings white back to 1.

    White is squared. What is above it is clipped at 1.
    """
    Lm, white = drawn(rng), float(rng.uniform(1.5, 6))
    Lm[0, :5] = white * np.array([1, 1.5, 2, 10, 100])
    expected = np.minimum(Lm * (1 + Lm / white**2) / (1 + Lm), 1)
    same(subject.display(Lm, Lm, white), expected, 1e-4, what="Ld", picture=True)


@points(2)
def test_a_pixel_is_held_back_by_its_neighbourhood(subject, rng):
    """Dodge and burn: whose brightness holds a pixel back?

    Below the fraction stands the neighbourhood, and above it the pixel.

    Ld = Lm / (1 + adaptation): the second argument.
    """
    Lm = drawn(rng)
    around = np.full_like(Lm, np.exp(rng.uniform(-1, 1)))
    same(
        subject.display(Lm, around), np.minimum(Lm / (1 + around), 1), 1e-4, what="Ld", picture=True
    )
    finite(subject.display(Lm * 1e6, around), Lm.shape, what="Ld")
