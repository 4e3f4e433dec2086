"""Checks of fit_space(curves, count), the space of response curves: (mean, H, sd)."""

import numpy as np

from hdrlab.course.checks.compare import finite, parts, points, same
from hdrlab.response import space


def draw_inputs(rng):
    """Return curves (C, n) and a number of components, with variances that are far apart."""
    x = np.linspace(0, 1, 40)
    gammas = np.exp(rng.normal(-0.5, 0.4, (14, 1)))
    shoulders = rng.normal(0, 0.3, (14, 1))
    toes = rng.normal(0, 0.05, (14, 1))
    bumps = np.sin(np.pi * x) * shoulders + np.sin(2 * np.pi * x) * toes
    return x**gammas + bumps, int(rng.integers(2, 4))


def get_answer(subject, curves, count):
    """Return mean (n,), H (K, n) and sd (K,) of the student's space."""
    mean, H, sd = parts(subject.fit_space(curves, count), 3, what="mean, H and sd")
    n = curves.shape[1]
    H = finite(H, (count, n), what="H").astype(float)
    return mean, H, finite(sd, (count,), what="sd").astype(float)


# the components of a few values are not unique
check_one_input = None


@points(1, needs="test_the_components_span_the_directions_of_largest_spread")
def test_the_mean_is_that_of_all_curves(subject, rng):
    """At each place, the space starts from one value. From which?

    From the mean of all curves there.

    mean[i] is the mean of curves[:, i].
    """
    curves, count = draw_inputs(rng)
    same(
        get_answer(subject, curves, count)[0], curves.mean(axis=0), 1e-5, what="mean", kind="curve"
    )


@points(5)
def test_the_components_span_the_directions_of_largest_spread(subject, rng):
    """Along which direction do the curves differ most?

    Along the first right singular vector of curves - mean.

    H is the first rows of V^T, with curves - mean = U S V^T. numpy returns V^T, not V.
    """
    curves, count = draw_inputs(rng)
    H = space.fit_space(curves, count).H
    answer = get_answer(subject, curves, count)[1]
    same(answer.T @ answer, H.T @ H, 1e-4, what="H^T H", picture=True)


@points(5)
def test_each_component_has_its_place_and_length_1(subject, rng):
    """Two students have different signs in a row of H. Who is right?

    Both. But the rows are orthogonal, have length 1, and begin with the direction of largest spread.

    Each row must be the library's, or its negative.
    """
    curves, count = draw_inputs(rng)
    H = space.fit_space(curves, count).H
    answer = get_answer(subject, curves, count)[1]
    same(np.abs(answer @ H.T), np.eye(count), 1e-3, what="the size of H times the right H^T")


@points(4)
def test_the_spread_is_the_standard_deviation_of_the_coefficients(subject, rng):
    """How far do the curves lie from the mean, along a row of H?

    By their coefficients, c = H (curve - mean). sd is the root mean square of these over all curves.

    sd = S / sqrt(C), with C curves.
    """
    curves, count = draw_inputs(rng)
    sd = space.fit_space(curves, count).sd
    same(get_answer(subject, curves, count)[2] / sd, np.ones(count), 1e-3, what="sd / the right sd")
