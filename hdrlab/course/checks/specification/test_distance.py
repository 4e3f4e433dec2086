"""Checks of distance(Z, skin), how far colors are from those of skin: (...)."""

import numpy as np

from hdrlab.course.checks.compare import points, same
from hdrlab.enhance import skin

TOLERANCE = 1e-3


def draw_colors(rng, *shape):
    return rng.uniform(20, 255, (*shape, 3))


def draw_skin(rng):
    """Return (mu, S) with chrominances that vary together, up or down."""
    spread = np.diag(rng.uniform(3, 8, 2))
    correlation = rng.choice([-1, 1]) * rng.uniform(0.6, 0.9)
    S = spread @ np.array([[1, correlation], [correlation, 1]]) @ spread
    return skin.Skin(rng.uniform(-25, 25, 2), S)


def is_valid_input(Z, gaussian):
    """Return whether S is the covariance matrix of some colors."""
    _, S = gaussian
    return np.array_equal(S, S.T) and np.linalg.eigvalsh(S).min() > 0


def same_distance(subject, Z, gaussian, what="d"):
    d = skin.distance(Z, gaussian)
    same(subject.distance(Z, gaussian), d, TOLERANCE * d.max(), what=what)


@points(6)
def test_the_distance_is_measured_in_standard_deviations(subject, rng):
    """A color is 10 from the mean. Is this far?

    It depends on how much skin varies in this direction: that is what S says.

    d = sqrt((x - mu)^T S^-1 (x - mu)), with the inverse of the matrix S.
    """
    gaussian = skin.Skin(rng.uniform(-25, 25, 2), np.diag(rng.uniform(3, 8, 2) ** 2))
    same_distance(subject, draw_colors(rng, 200), gaussian)


@points(4)
def test_chrominances_that_vary_together_count_as_one(subject, rng):
    """In skin, a pixel with more Cr has less Cb. Is one with more of both far away?

    Yes, and one with more Cr and less Cb is not. The elements of S beside its diagonal say so.

    Use the whole inverse of S, not only the two variances.
    """
    same_distance(subject, draw_colors(rng, 200), draw_skin(rng), what="d for a full S")


@points(3)
def test_a_color_in_the_shade_is_as_far_as_in_the_light(subject, rng):
    """All of R, G and B are halved. How does the distance change?

    It stays: skin in the shade is skin.

    Multiply Cb and Cr by 128 / Y.
    """
    gaussian = draw_skin(rng)
    Z = draw_colors(rng, 50)
    shaded = Z * rng.uniform(0.2, 0.9, (50, 1))
    answer = np.asarray(subject.distance(shaded, gaussian))
    same(answer, skin.distance(Z, gaussian), TOLERANCE * 50, what="d in the shade")


@points(1, needs="test_the_distance_is_measured_in_standard_deviations")
def test_black_has_no_color(subject, rng):
    """R = G = B = 0. What is Cb / Y?

    Nothing: 0 / 0. Divide by 1 instead of Y if Y is below 1.

    np.maximum(Y, 1)
    """
    Z = draw_colors(rng, 20)
    Z[:3] = [[0, 0, 0], [0, 0, 1], [2, 0, 0]]
    same_distance(subject, Z, draw_skin(rng), what="d with black pixels")


@points(1, needs="test_the_distance_is_measured_in_standard_deviations")
def test_an_image_gives_one_distance_per_pixel(subject, rng):
    """Z is an image, (H, W, 3). Which shape has d?

    (H, W), one distance for each pixel.

    Use Z[..., 0] for red, so that the shape does not matter.
    """
    same_distance(subject, draw_colors(rng, 5, 8), draw_skin(rng), what="d of an image")
