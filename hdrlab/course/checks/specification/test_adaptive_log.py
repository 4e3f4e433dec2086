"""Checks of adaptive_log(L, Lwa, Lmax, bias), Drago's curve: Ld, display luminance."""

import numpy as np

from hdrlab.course.checks.compare import points, same
from hdrlab.tonemap import drago


def is_valid_input(L, Lwa, Lmax, bias):
    """Return whether the luminances are those of a scene, and the bias is one that is used."""
    in_range = bool((L >= 0).all() and (L <= Lmax).all())
    return in_range and 0 < Lwa < Lmax and 0.75 <= bias <= 1


def draw_scene(rng):
    """Return luminances from dark to Lmax, their log average, and Lmax."""
    Lmax = rng.uniform(30, 60)
    L = np.sort(Lmax * 10 ** rng.uniform(-3, 0, 60))
    Lwa = float(np.exp(np.mean(np.log(L))))
    return L, Lwa, Lmax


def agree(subject, L, Lwa, Lmax, bias, *, what):
    expected = drago.adaptive_log(L, Lwa, Lmax, bias=bias)
    answer = subject.adaptive_log(L, Lwa, Lmax, bias=bias)
    same(answer, expected, 1e-4, what=what, kind="curve")


@points(3)
def test_with_a_bias_of_1_the_base_is_10(subject, rng):
    """With a bias of 1, the exponent is 0. What is the base of each pixel?

    ln 1 = 0, and x^0 = 1, so the base is 2 + 8 = 10 for all pixels above 0.

    Then Ld = log10(Lw + 1) / log10(Lwmax + 1).
    """
    L, _, Lmax = draw_scene(rng)
    agree(subject, L, 1.0, Lmax, 1.0, what="Ld with a bias of 1")


@points(6)
def test_the_bias_sets_the_base_of_the_middle_tones(subject, rng):
    """What is the base where Lw is half of Lwmax?

    0.5^(ln b / ln 0.5) = b, so it is 2 + 8 b.

    The quotient of the two logarithms is an exponent. It is 0 for b = 1, and positive below.
    """
    L, _, Lmax = draw_scene(rng)
    bias = rng.uniform(0.75, 0.9)
    agree(subject, L, 1.0, Lmax, bias, what=f"Ld with a bias of {bias:.2f}")


@points(1)
def test_black_is_0_and_the_brightest_is_1(subject, rng):
    """What does the curve make of 0, and of Lmax?

    For black, the base is 2 and log(0 + 1) = 0.

    For Lmax, the base is 10, and numerator and denominator are equal.
    """
    _, Lwa, Lmax = draw_scene(rng)
    ends = rng.permutation([0.0, Lmax, Lmax])
    answer = subject.adaptive_log(ends, Lwa, Lmax, bias=0.85)
    same(answer, (ends > 0).astype(float), 1e-4, what="Ld of black and of the brightest luminance")


@points(3)
def test_luminance_is_measured_in_log_averages(subject, rng):
    """The same scene under twice the light: the eye adapts. What should the image do?

    Divide L by Lwa before anything else.

    Lmax is a luminance as well: Lwmax = Lmax / Lwa.
    """
    L, Lwa, Lmax = draw_scene(rng)
    unit = rng.uniform(5, 20)
    agree(subject, unit * L, unit * Lwa, unit * Lmax, 0.85, what="Ld in another unit")


@points(2)
def test_every_pixel_of_an_image_is_mapped_by_itself(subject, rng):
    """An image has rows and columns. Does your function keep its shape?

    The base is a different number for each pixel, and Lwa and Lmax are the same for all.

    Compute with the whole array at once, and return an array of the same shape.
    """
    L, Lwa, Lmax = draw_scene(rng)
    image = rng.permutation(L).reshape(6, 10)
    expected = drago.adaptive_log(image, Lwa, Lmax, bias=0.85)
    same(subject.adaptive_log(image, Lwa, Lmax, bias=0.85), expected, 1e-4, what="Ld of an image")
