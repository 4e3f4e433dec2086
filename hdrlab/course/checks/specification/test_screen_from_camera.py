"""Checks of screen_from_camera(M, P), the conversion C of balanced camera channels to a screen's RGB."""

import numpy as np

from hdrlab.capture import development
from hdrlab.course.checks.compare import points, same


def random_camera(rng):
    """Return M, from XYZ to the channels of a camera: overlapping filters of different sensitivity."""
    overlap = np.eye(3) + rng.uniform(0.1, 0.3, (3, 3))
    sensitivity = rng.uniform(0.4, 1.2, (3, 1))
    return sensitivity * overlap @ np.linalg.inv(development.XYZ_OF_SRGB)


def random_screen(rng):
    """Return P, the XYZ of a screen's red, green and blue, near those of sRGB."""
    return development.XYZ_OF_SRGB * rng.uniform(0.9, 1.1, (3, 3))


@points(4)
def test_gray_of_the_camera_is_gray_on_the_screen(subject, rng):
    """After white balance, white is (1, 1, 1) in the camera, and it is (1, 1, 1) on the screen.

    C must take (1, 1, 1) to (1, 1, 1). What does this say about the sum of each of its rows?

    Divide each row of A = M P by its sum before you invert it.
    """
    M = random_camera(rng)
    P = random_screen(rng)
    answer = np.asarray(subject.screen_from_camera(M, P))
    same(answer @ np.ones(3), np.ones(3), 1e-6, what="C (1, 1, 1)")


@points(3)
def test_a_camera_whose_channels_are_balanced_needs_the_inverse_alone(subject, rng):
    """If white is (1, 1, 1) in the camera without gains, dividing by the sums changes nothing.

    A takes RGB of the screen to the camera. C goes back.

    Then C is the inverse of A = M P.
    """
    P = random_screen(rng)
    A = random_camera(rng) @ P
    A = A / A.sum(axis=1, keepdims=True)
    answer = subject.screen_from_camera(A @ np.linalg.inv(P), P)
    same(answer, np.linalg.inv(A), 1e-6, what="C")


@points(6)
def test_colors_of_the_screen_come_back(subject, rng):
    """A color of the screen, seen by the camera and balanced, must be the same color after C.

    A takes RGB to the camera's channels. White balance divides these by the channels of white.

    C is the inverse of A, after each row of A was divided by its sum.
    """
    M = random_camera(rng)
    P = random_screen(rng)
    expected = development.screen_from_camera(M, P)
    same(subject.screen_from_camera(M, P), expected, 1e-6, what="C")


@points(5)
def test_the_sensitivity_of_the_filters_does_not_matter(subject, rng):
    """If a filter lets half of the light pass, its row of M is half as large, and its gain is doubled.

    White balance cancels the sensitivity of each filter. So C must not depend on it.

    Dividing the rows of A by their sums cancels any factor of a row.
    """
    overlap = random_camera(rng)
    P = random_screen(rng)
    M = rng.choice([0.25, 4.0], (3, 1)) * overlap
    expected = development.screen_from_camera(overlap, P)
    same(subject.screen_from_camera(M, P), expected, 1e-6, what="C")
