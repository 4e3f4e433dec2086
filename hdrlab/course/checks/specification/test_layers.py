"""Durand's two layers: layers(lL, sigma_s, sigma_r) -> base, detail, in decades."""

import numpy as np

from hdrlab.core.filters.bilateral import bilateral
from hdrlab.course.checks.compare import finite, parts, points, require, same

SIGMA = {"sigma_s": 4.0, "sigma_r": 0.4}


def drawn(rng, shape=(40, 56), texture=0.12):
    """Return log luminance: two walls of different light, and texture on both."""
    x = np.arange(shape[1])
    light = np.where(x < rng.integers(20, 36), 0.0, float(rng.choice([-1, 1]) * rng.uniform(2, 3)))
    return (light + texture * rng.standard_normal(shape)).astype(np.float32)


def asked(subject, lL, **knobs):
    """Return base and detail."""
    base, detail = parts(subject.layers(lL, **(knobs or SIGMA)), 2, what="base and detail")
    return finite(base, lL.shape, what="the base"), finite(detail, lL.shape, what="the detail")


@points(2)
def test_the_layers_add_up_to_the_picture(subject, rng):
    """Base and detail together are the picture.

    Battiato and others (2008) print the difference the other way round.

    detail = lL - base.
    """
    lL = drawn(rng)
    base, detail = asked(subject, lL)
    same(base + detail, lL, 1e-3, what="base + detail", picture=True)
    said = "the detail: expected the texture of the walls, got hardly any"
    require(detail.std() > 0.01, said, came=detail, kind="image")


@points(5)
def test_the_base_is_the_bilateral_filter(subject, rng):
    """Each pixel of the base is a weighted mean of its neighbours.

    Two Gaussians multiply: one of the distance, one of the difference in lL.

    Divide by the sum of the weights; the exponents are -d^2 / (2 sigma^2).
    """
    lL = drawn(rng)
    found = bilateral(lL, **SIGMA)
    base, _ = asked(subject, lL)
    same(base, found.mean, 0.02, what="the base", picture=True, where=found.k > 20)


@points(3, needs="test_the_base_is_the_bilateral_filter")
def test_an_edge_of_light_stays_in_the_base_and_out_of_the_detail(subject, rng):
    """Plot a row of the base across the edge.

    A plain blur washes the edge out, and makes a halo.

    A neighbour that differs by much more than sigma_r has hardly any weight.
    """
    lL = drawn(rng, texture=0.0)
    base, detail = asked(subject, lL)
    same(base, lL, 0.03, what="the base of two even walls", picture=True)
    same(detail, np.zeros(lL.shape), 0.03, what="the detail of two even walls", picture=True)


@points(2, needs="test_the_base_is_the_bilateral_filter")
def test_another_exposure_moves_the_base_and_leaves_the_detail(subject, rng):
    """Twice the light adds a constant to lL. What should it add to the base?

    The weights depend on differences alone.

    No logarithm is taken here: lL is one already.
    """
    lL = drawn(rng)
    (base, detail), (moved, same_detail) = asked(subject, lL), asked(subject, lL + np.float32(1.3))
    same(
        moved - base, np.full(lL.shape, 1.3), 0.02, what="what 20 times the light adds to the base"
    )
    same(same_detail, detail, 0.02, what="the detail", picture=True)
    same((base + detail).mean(), lL.mean(), 0.01, what="the mean of base + detail")
