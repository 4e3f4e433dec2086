"""Checks of variance(X, D, N, R), the noise of one photo: V, the variance of the exposure, with
the shape of X.
"""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same


def draw_inputs(rng):
    """Return exposures and their steps (24, 30), the electrons at exposure 1, and the read noise
    in electrons.
    """
    X = np.exp(rng.uniform(-5, 1, (24, 30)))
    return (
        X,
        X * rng.uniform(0.02, 0.2, X.shape),
        float(rng.uniform(200, 2000)),
        float(rng.uniform(20, 40)),
    )


def alike(answer, V, what):
    """Compare by the ratio, because errors of a variance are factors."""
    ratio = finite(answer, V.shape, what=what) / V
    same(ratio, np.ones(V.shape), 0.01, what=f"{what} / the correct V", picture=True)


def test_without_any_cause_there_is_no_noise(subject, rng):
    """Here all three causes of noise are 0. What should V be?

    Each of the three causes has its own term, and each term is 0 here.

    The result has the shape of X. Do not add anything to the three terms.
    """
    X, _, N, _ = draw_inputs(rng)
    same(subject.variance(0 * X, 0 * X, N, 0.0), 0 * X, 1e-12, what="V without noise", picture=True)


@points(3)
def test_photon_noise_grows_with_the_light(subject, rng):
    """The sensor counts X N electrons. What is the variance of this count?

    The variance of the count is the count itself. V is the variance of the exposure, which is the
    count divided by N.

    Var(x / N) = Var(x) / N^2, so the first term is X N / N^2.
    """
    X, _, N, _ = draw_inputs(rng)
    alike(subject.variance(X, 0 * X, N, 0.0), X / N, "V of photon noise alone")


@points(3)
def test_read_noise_does_not_depend_on_the_light(subject, rng):
    """Which noise remains without any light?

    R is a standard deviation in electrons. A variance is its square, and N electrons are an
    exposure of 1.

    The second term is (R / N)^2, for any X.
    """
    X, _, N, R = draw_inputs(rng)
    alike(
        subject.variance(0 * X, 0 * X, N, R),
        np.full(X.shape, (R / N) ** 2),
        "V of read noise alone",
    )


@points(3)
def test_rounding_noise_is_that_of_a_uniform_distribution(subject, rng):
    """All exposures within a step D are rounded to the same level.

    The exposure is uniformly distributed from -D / 2 to D / 2 around it. Its variance is the
    integral of x^2 / D.

    The third term is D^2 / 12.
    """
    X, D, N, _ = draw_inputs(rng)
    alike(subject.variance(0 * X, D, N, 0.0), D**2 / 12, "V of rounding alone")


@points(2)
def test_variances_of_independent_causes_add(subject, rng):
    """The three causes are independent of each other.

    So their variances add, not their standard deviations.

    V = X / N + (R / N)^2 + D^2 / 12.
    """
    X, D, N, R = draw_inputs(rng)
    alike(subject.variance(X, D, N, R), X / N + (R / N) ** 2 + D**2 / 12, "V of all three causes")
