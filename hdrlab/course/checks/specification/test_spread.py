"""Checks of spread(L, Ld, bins): how far apart equal luminances are displayed."""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.course.checks.compare import finite, parts, points, require, same
from hdrlab.tonemap import curves

SHAPE = (24, 30)
BINS = (12, 24, 36, 60)


def draw_inputs(rng, local=True):
    """Return luminance, display luminance and a number of classes; no two pixels are alike."""
    L = np.exp(rng.normal(0, 1.5, SHAPE) + 0.1 * np.arange(SHAPE[1]))
    Ld = L / (1 + L)
    if local:
        surround = gaussian_filter(rng.standard_normal(SHAPE), 1.5)
        Ld = Ld * np.exp(0.6 * surround) / 2
    return L.astype(np.float32), Ld.astype(np.float32), int(rng.choice(BINS))


# right answers name any luminance of a class, so those of a class are almost alike
SMALL_INPUTS = [
    (np.array([[1, 1.001, 4, 4.001]]), np.array([[0.1, 0.4, 0.7, 0.5]]), {"bins": 2}),
    (np.array([[4, 4.001, 1, 1.001]]), np.array([[0.2, 0.5, 0.1, 0.4]]), {"bins": 2}),
    (np.array([[1, 1.001, 1.002]]), np.array([[0.1, 0.2, 0.6]]), {"bins": 1}),
    (
        np.array([[1, 1.001, 2, 2.001, 90, 90.001]]),
        np.array([[0.1, 0.2, 0.3, 0.4, 0.8, 0.9]]),
        {"bins": 3},
    ),
]


def get_answer(subject, L, Ld, bins):
    what = "luminance, minimum and maximum"
    return parts(subject.spread(L, Ld, bins=bins), 3, what=what)


@points(4)
def test_an_operator_draws_a_band(subject, rng):
    """Pixels of nearly the same luminance are displayed differently. How differently?

    From the smallest to the largest Ld of their class.

    Sort the pixels by L, and take Ld in this order. Then each class is a part of the array.
    """
    L, Ld, bins = draw_inputs(rng)
    _, lowest, highest = curves.spread(L, Ld, bins=bins)
    _, answer_lowest, answer_highest = get_answer(subject, L, Ld, bins)
    same(answer_lowest, lowest, 1e-5, what="the minimum of Ld", kind="curve")
    same(answer_highest, highest, 1e-5, what="the maximum of Ld", kind="curve")


@points(3)
def test_a_curve_draws_itself(subject, rng):
    """Ld is a function of L alone. How wide is the band?

    As wide as the function rises within the class.

    All classes have the same number of pixels, also where L is rare.
    """
    L, Ld, bins = draw_inputs(rng, local=False)
    _, lowest, highest = curves.spread(L, Ld, bins=bins)
    _, answer_lowest, answer_highest = get_answer(subject, L, Ld, bins)
    same(answer_lowest, lowest, 1e-5, what="the minimum of Ld of a curve", kind="curve")
    same(answer_highest, highest, 1e-5, what="the maximum of Ld of a curve", kind="curve")


@points(3)
def test_the_luminance_is_one_of_the_class(subject, rng):
    """At which L should the band be drawn?

    At one in its class: the one in the middle, for example.

    Return luminances, not their numbers or logarithms; the darkest class first.
    """
    L, Ld, bins = draw_inputs(rng)
    classes = np.sort(L, axis=None).reshape(bins, -1).astype(float)
    answer = finite(get_answer(subject, L, Ld, bins)[0], (bins,), what="luminance").astype(float)
    inside = (answer >= classes[:, 0] * 0.9999) & (answer <= classes[:, -1] * 1.0001)
    require(
        inside.all(),
        f"luminance: {np.count_nonzero(~inside)} of {bins} are not in their class",
        expected=np.median(classes, axis=1),
        answer=answer,
        kind="curve",
    )
