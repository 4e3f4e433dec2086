"""Checks of layers(lL, sigma_s, sigma_r), Durand's two layers: base and detail, in decades."""

import numpy as np

from hdrlab.core.filters.bilateral import bilateral
from hdrlab.course.checks.compare import finite, parts, points, require, same

SIGMA = {"sigma_s": 4.0, "sigma_r": 0.3}  # not the default


def draw_inputs(rng, shape=(40, 56), texture=0.12):
    """Return log luminance of two walls in different light, both with texture."""
    x = np.arange(shape[1])
    light = np.where(x < rng.integers(20, 36), 0.0, float(rng.choice([-1, 1]) * rng.uniform(2, 3)))
    return (light + texture * rng.standard_normal(shape)).astype(np.float32)


def get_answer(subject, lL, **options):
    """Return base and detail."""
    base, detail = parts(subject.layers(lL, **(options or SIGMA)), 2, what="base and detail")
    return finite(base, lL.shape, what="the base"), finite(detail, lL.shape, what="the detail")


def draw_pixel(value):
    """Return an image of zeros with one other value in its middle, far from the borders."""
    image = np.zeros((9, 9), np.float32)
    image[4, 4] = value
    return image


# near a border, right filters differ
SMALL_INPUTS = [
    (np.full((1, 1), 2, np.float32), {"sigma_s": 1.0, "sigma_r": 1.0}),
    (draw_pixel(1.0), {"sigma_s": 1.0, "sigma_r": 1.0}),
    (draw_pixel(1.0), {"sigma_s": 1.0, "sigma_r": 0.5}),
    (draw_pixel(1.0), {"sigma_s": 0.5, "sigma_r": 1.0}),
]


def check_one_input(subject, lL, **options):
    """Compare the layers. Right filters with windows of other sizes differ by 0.04."""
    mean = bilateral(lL, **options).mean
    base, detail = get_answer(subject, lL, **options)
    same(base, mean, 0.05, what="the base")
    same(detail, lL - mean, 0.05, what="the detail")


@points(2)
def test_the_layers_add_up_to_the_image(subject, rng):
    """Base plus detail must be the input lL.

    Battiato and others (2008) print the difference with the wrong sign.

    detail = lL - base.
    """
    lL = draw_inputs(rng)
    base, detail = get_answer(subject, lL)
    same(base + detail, lL, 1e-3, what="base + detail", picture=True)
    message = "the detail: expected the texture of the walls, got almost none"
    require(detail.std() > 0.01, message, answer=detail, kind="image")


@points(5)
def test_the_base_is_the_bilateral_filter(subject, rng):
    """Each pixel of the base is a weighted mean of its neighbors.

    Multiply two Gaussians: one of the distance, one of the difference in lL.

    Divide by the sum of the weights. The exponents are -d^2 / (2 sigma^2).
    """
    lL = draw_inputs(rng)
    expected = bilateral(lL, **SIGMA)
    base, _ = get_answer(subject, lL)
    same(base, expected.mean, 0.02, what="the base", picture=True, where=expected.k > 20)


@points(3, needs="test_the_base_is_the_bilateral_filter")
def test_a_strong_edge_stays_in_the_base(subject, rng):
    """Plot a row of the base across the edge. Is the edge still sharp?

    A plain blur smooths the edge and leaves a halo in the detail.

    A neighbor that differs by much more than sigma_r must have almost no weight.
    """
    lL = draw_inputs(rng, texture=0.0)
    base, detail = get_answer(subject, lL)
    same(base, lL, 0.03, what="the base of two uniform walls", picture=True)
    same(detail, np.zeros(lL.shape), 0.03, what="the detail of two uniform walls", picture=True)


@points(2, needs="test_the_base_is_the_bilateral_filter")
def test_more_light_changes_the_base_but_not_the_detail(subject, rng):
    """More light adds a constant to lL. What should it add to the base?

    The same constant: the weights depend only on differences of lL.

    Do not take a logarithm; lL is one already.
    """
    lL = draw_inputs(rng)
    base, detail = get_answer(subject, lL)
    shifted_base, same_detail = get_answer(subject, lL + np.float32(1.3))
    same(
        shifted_base - base,
        np.full(lL.shape, 1.3),
        0.02,
        what="the change of the base with 20 times the light",
    )
    same(same_detail, detail, 0.02, what="the detail", picture=True)
    same((base + detail).mean(), lL.mean(), 0.01, what="the mean of base + detail")
