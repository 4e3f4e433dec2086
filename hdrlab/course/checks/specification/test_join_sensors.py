"""Checks of join_sensors(B, D, full), the radiance from two sensors, and the case of each pixel."""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.beyond import splitter
from hdrlab.course.checks.compare import parts, points, require, same

SHAPE = (34, 42)
TOLERANCE = 1e-4


def draw_inputs(rng):
    """Return B, D and where B is full: a spot of full pixels, and single ones."""
    y, x = np.indices(SHAPE)
    E = 1 + 0.5 * gaussian_filter(rng.standard_normal(SHAPE), 2)
    row = rng.integers(12, 22)
    column = rng.integers(12, 30)
    E += 6 * np.exp(-((y - row) ** 2 + (x - column) ** 2) / 60)
    full = E > 2.5
    full[rng.integers(2, 30, 8), rng.integers(2, 40, 8)] = True
    B = E * rng.uniform(0.97, 1.03, SHAPE)
    B[full] = 2.5
    D = 0.85 * E * rng.uniform(0.9, 1.1, SHAPE)
    return B, D, full


def inner(shape):
    """Return the pixels whose windows lie in the image."""
    mask = np.zeros(shape, bool)
    mask[2:-2, 2:-2] = True
    return mask


def get_answer(subject, B, D, full):
    return parts(subject.join_sensors(B, D, full), 2, what="E and the cases")


def same_case(subject, rng, number):
    B, D, full = draw_inputs(rng)
    E, case = splitter.join_sensors(B, D, full)
    where = inner(SHAPE) & (case == number)
    require(where.any(), "the drawn photo lacks this case")
    answer = get_answer(subject, B, D, full)[0]
    same(answer, E, TOLERANCE, what=f"E in case {number}", where=where, picture=True)


@points(2, needs="test_a_full_pixel_is_predicted_from_its_neighbors")
def test_far_from_full_pixels_the_brighter_sensor_is_used_alone(subject, rng):
    """Both sensors measure. Which has less noise?

    The brighter one: it got more light.

    Where no pixel of the window is full, E = B.
    """
    same_case(subject, rng, 1)


@points(5)
def test_near_full_pixels_the_sensors_are_mixed(subject, rng):
    """Why not use B up to the first full pixel, and D from there on?

    A seam would be visible where the two differ.

    E = (1 - u) B + u D, where u is the fraction of the 5 x 5 pixels that are full.
    """
    same_case(subject, rng, 2)


@points(6)
def test_a_full_pixel_is_predicted_from_its_neighbors(subject, rng):
    """B is full at a pixel, but not all around it. What would B be there?

    D there, times the quotient of B and D around it.

    P = D sum(B) / sum(D), both sums over the pixels of the window where B is not full.
    """
    same_case(subject, rng, 3)


@points(2, needs="test_a_full_pixel_is_predicted_from_its_neighbors")
def test_among_full_pixels_the_darker_sensor_is_used_alone(subject, rng):
    """B is full everywhere around a pixel. What is left?

    D, the radiance from the darker sensor.

    Where u = 1, E = D.
    """
    same_case(subject, rng, 4)


@points(3)
def test_each_pixel_has_its_case(subject, rng):
    """Which two questions decide which case a pixel has?

    Is it full itself? Are none, some or all pixels of its window full?

    1 and 2: not full; 3 and 4: full. In 2 and 3, some pixels of the window are full.
    """
    B, D, full = draw_inputs(rng)
    case = splitter.join_sensors(B, D, full)[1]
    answer = get_answer(subject, B, D, full)[1]
    same(answer, case, 0, what="the cases", where=inner(SHAPE), picture=True)


@points(2, needs="test_near_full_pixels_the_sensors_are_mixed")
def test_at_the_border_the_last_pixels_go_on(subject, rng):
    """The window of a pixel at the border leaves the image. What is out there?

    The nearest pixel of the image, again and again.

    scipy.ndimage.uniform_filter(..., 5, mode="nearest"), or np.pad(..., 2, mode="edge").
    """
    B, D, full = draw_inputs(rng)
    full[:4, :7] = True
    full[-1, 10:20] = True
    E = splitter.join_sensors(B, D, full)[0]
    answer = get_answer(subject, B, D, full)[0]
    same(answer, E, TOLERANCE, what="E at the border", where=~inner(SHAPE), picture=True)
