"""Checks of guided(I, p, radius, epsilon), the guided filter: q (H, W), the average of linear
models in windows.
"""

import numpy as np

from hdrlab.core.filters.guided import guided
from hdrlab.course.checks.compare import finite, points, same

SHAPE = (36, 48)


def draw_inputs(rng):
    """Return a guide of two walls with texture, another image of the same walls, and the
    parameters.
    """
    wall = np.arange(SHAPE[1]) < rng.integers(18, 30)
    guide, p = (wall * rng.uniform(1, 2) + 0.2 * rng.standard_normal(SHAPE) for _ in range(2))
    return guide, p, {"radius": int(rng.integers(2, 5)), "epsilon": float(rng.uniform(0.02, 0.1))}


def inside(radius):
    """Return a mask of the pixels that only complete windows influence."""
    mask = np.zeros(SHAPE, bool)
    mask[2 * radius : -2 * radius, 2 * radius : -2 * radius] = True
    return mask


def get_answer(subject, *images, radius, epsilon):
    """Return the answer of a subject for the variance `epsilon`, passed as on the sheet."""
    return subject.guided(*images, radius=radius, epsilon=epsilon)


def solution(*images, **options):
    """Return the right answer, of a guide and of the image to filter, if it is another one."""
    return guided(*images, **options)


def draw_pixel(value):
    """Return an image of zeros with one other value in its middle, far from the borders."""
    image = np.zeros((13, 13))
    image[6, 6] = value
    return image


# near a border, right filters differ
SMALL_INPUTS = [
    (draw_pixel(1.0), {"radius": 1, "epsilon": 0.25}),
    (draw_pixel(1.0), draw_pixel(2.0), {"radius": 1, "epsilon": 0.25}),
    (draw_pixel(2.0), draw_pixel(1.0), {"radius": 1, "epsilon": 0.25}),
    (draw_pixel(1.0), {"radius": 2, "epsilon": 0.25}),
]


@points(6)
def test_an_image_is_smoothed_along_its_guide(subject, rng):
    """Each window has its own model, q = a I + b. A pixel is in many windows: average their models.

    a = cov(I, p) / (var(I) + eps), and b = mean(p) - a mean(I). Then q = mean(a) I + mean(b).

    All means are over (2 r + 1) x (2 r + 1) pixels, and cov(I, p) = mean(I p) - mean(I) mean(p).
    """
    guide, p, options = draw_inputs(rng)
    expected = solution(guide, p, **options)
    where = inside(options["radius"])
    same(
        get_answer(subject, guide, p, **options),
        expected,
        1e-3,
        what="q",
        picture=True,
        where=where,
    )


@points(4)
def test_an_image_that_guides_itself_keeps_its_edges(subject, rng):
    """If p is not given, use I in its place.

    At the edge, the variance is far above eps, so a is near 1. On a wall it is far below, so a is
    near 0.

    cov(I, I) is the variance of I.
    """
    guide, _, options = draw_inputs(rng)
    expected = solution(guide, **options)
    where = inside(options["radius"])
    same(get_answer(subject, guide, **options), expected, 1e-3, what="q", picture=True, where=where)


@points(1, needs="test_an_image_is_smoothed_along_its_guide")
def test_a_large_epsilon_leaves_the_mean_of_means(subject, rng):
    """What is a if eps is much larger than every variance?

    Then a is 0, and b is the mean of p.

    Average b, too: the result is a mean of means.
    """
    guide, p, options = draw_inputs(rng)
    options["epsilon"] = 1e6
    expected = solution(guide, p, **options)
    where = inside(options["radius"])
    same(
        get_answer(subject, guide, p, **options),
        expected,
        1e-3,
        what="q",
        picture=True,
        where=where,
    )


@points(2)
def test_scaling_and_shifting_p_scales_and_shifts_q(subject, rng):
    """Filter p, and then 2 p + 3. How must the two results differ?

    The second result must be 2 q + 3: q depends on p only through means.

    A constant added to p goes into b. A factor of p goes into a and b.
    """
    guide, p, options = draw_inputs(rng)
    q, again = (
        finite(get_answer(subject, guide, x, **options), SHAPE, what="q") for x in (p, 2 * p + 3)
    )
    same(again, 2 * q + 3, 1e-3, what="q of 2 p + 3", picture=True, where=inside(options["radius"]))
