"""The noise of one photograph: variance(X, D, N, R) -> V of the exposure, of the shape of X."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same


def drawn(rng):
    """Return exposures and their steps (24, 30), electrons at exposure 1, and the read noise in electrons."""
    X = np.exp(rng.uniform(-5, 1, (24, 30)))
    return (
        X,
        X * rng.uniform(0.02, 0.2, X.shape),
        float(rng.uniform(200, 2000)),
        float(rng.uniform(20, 40)),
    )


def alike(came, V, what):
    """Compare by the ratio: a variance is right or wrong by a factor."""
    ratio = finite(came, V.shape, what=what) / V
    same(ratio, np.ones(V.shape), 0.01, what=f"{what}, over what it should be", picture=True)


def test_no_light_no_amplifier_and_no_rounding_have_no_noise(subject, rng):
    """Where would noise come from, if nothing makes any?

    Each of the three causes has a term of its own, and each of them is 0 here.

    The answer has the shape of X, and nothing is added to the three terms.
    """
    X, _, N, _ = drawn(rng)
    same(subject.variance(0 * X, 0 * X, N, 0.0), 0 * X, 1e-12, what="V of nothing", picture=True)


@points(3)
def test_photons_have_a_variance_that_grows_with_the_light(subject, rng):
    """X N electrons were counted. By how many do counts of photons differ?

    The variance of a count is the count. V is not that of the count, but of the exposure: the count
    over N.

    Var(x / N) = Var(x) / N^2, so the first term is X N / N^2.
    """
    X, _, N, _ = drawn(rng)
    alike(subject.variance(X, 0 * X, N, 0.0), X / N, "V of photons alone")


@points(3)
def test_the_amplifier_adds_as_much_in_the_dark(subject, rng):
    """Without any light, what is left?

    R is a standard deviation, in electrons. A variance is the square, and N electrons are an
    exposure of 1.

    The second term is (R / N)^2, whatever X is.
    """
    X, _, N, R = drawn(rng)
    alike(
        subject.variance(0 * X, 0 * X, N, R),
        np.full(X.shape, (R / N) ** 2),
        "V of the amplifier alone",
    )


@points(3)
def test_rounding_spreads_the_light_evenly_over_a_step(subject, rng):
    """All exposures of a step D are rounded to one level, so the light lay anywhere in it.

    What is spread evenly from -D / 2 to D / 2 has the variance that an integral of x^2 / D gives.

    The third term is D^2 / 12.
    """
    X, D, N, _ = drawn(rng)
    alike(subject.variance(0 * X, D, N, 0.0), D**2 / 12, "V of rounding alone")


@points(2)
def test_variances_of_what_knows_nothing_of_each_other_add(subject, rng):
    """Three causes, and none knows of the others.

    Their variances add, and not their standard deviations.

    V = X / N + (R / N)^2 + D^2 / 12.
    """
    X, D, N, R = drawn(rng)
    alike(subject.variance(X, D, N, R), X / N + (R / N) ** 2 + D**2 / 12, "V of all three")
