"""The guided filter: guided(I, p, radius, epsilon) -> q, lines of windows, averaged."""

import numpy as np

from hdrlab.core.filters.guided import guided
from hdrlab.course.checks.compare import finite, points, same

SHAPE = (36, 48)


def drawn(rng):
    """Return a guide of two walls with texture, another picture of the same walls, and the knobs."""
    wall = np.arange(SHAPE[1]) < rng.integers(18, 30)
    guide, p = (wall * rng.uniform(1, 2) + 0.2 * rng.standard_normal(SHAPE) for _ in range(2))
    return guide, p, {"radius": int(rng.integers(2, 5)), "epsilon": float(rng.uniform(0.02, 0.1))}


def inside(radius):
    """Return a mask of the pixels whose windows, and all windows that hold them, lie in the picture."""
    mask = np.zeros(SHAPE, bool)
    mask[2 * radius : -2 * radius, 2 * radius : -2 * radius] = True
    return mask


@points(6)
def test_a_picture_is_smoothed_along_its_guide(subject, rng):
    """Each window has a line, p = a I + b. A pixel lies in many windows: which line is its own?

    a = cov(I, p) / (var(I) + eps), b = mean(p) - a mean(I); q is the mean of a times I, plus the
    mean of b.

    All of it are means over (2 r + 1) x (2 r + 1) pixels: cov(I, p) = mean(I p) - mean(I) mean(p).
    """
    guide, p, knobs = drawn(rng)
    expected, where = guided(guide, p, **knobs), inside(knobs["radius"])
    same(subject.guided(guide, p, **knobs), expected, 1e-3, what="q", picture=True, where=where)


@points(4)
def test_a_picture_that_guides_itself_keeps_its_edge(subject, rng):
    """Where no p is given, I takes its place.

    Beside the edge the variance is far above eps, and a is near 1; on a wall it is below, and a is
    near 0.

    cov(I, I) is the variance of I.
    """
    guide, _, knobs = drawn(rng)
    expected, where = guided(guide, **knobs), inside(knobs["radius"])
    same(subject.guided(guide, **knobs), expected, 1e-3, what="q", picture=True, where=where)


@points(1, needs="test_a_picture_is_smoothed_along_its_guide")
def test_where_every_edge_is_small_only_means_are_left(subject, rng):
    """With an eps far above every variance, what is left of a?

    a is 0 then, and b the mean of p.

    The mean of all b is a mean of means.
    """
    guide, p, knobs = drawn(rng)
    knobs["epsilon"] = 1e6
    expected, where = guided(guide, p, **knobs), inside(knobs["radius"])
    same(subject.guided(guide, p, **knobs), expected, 1e-3, what="q", picture=True, where=where)


@points(2)
def test_another_unit_and_zero_of_p_are_those_of_q(subject, rng):
    """Filter p, and then 2 p + 3. What should the second answer be?

    The guide alone says where the edges are: nothing but means is taken of p.

    A constant goes into b, and a factor into both a and b.
    """
    guide, p, knobs = drawn(rng)
    q, again = (finite(subject.guided(guide, x, **knobs), SHAPE, what="q") for x in (p, 2 * p + 3))
    same(again, 2 * q + 3, 1e-3, what="q of 2 p + 3", picture=True, where=inside(knobs["radius"]))
