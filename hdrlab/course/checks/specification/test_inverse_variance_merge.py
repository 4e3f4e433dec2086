"""Checks of inverse_variance_merge(X, D, measured, t, N, R), the most certain mean: E and s,
each (H, W).
"""

import numpy as np

from hdrlab.course.checks.compare import finite, parts, points, same
from hdrlab.radiance.uncertainty import inverse_variance_merge, variance

TIMES = np.array([1.0, 4.0, 16.0])
SHAPE = (30, 40)


def counted(rng, times=TIMES, dimmest=2.0):
    """Return the measurements of a linear camera, as a student gets them, and the true radiance."""
    N = float(rng.uniform(800, 1200))
    R = float(rng.uniform(2, 4))
    E = np.exp(rng.uniform(np.log(dimmest / N), np.log(0.2), SHAPE))
    t = times[:, None, None]
    X = (rng.poisson(E * t * N) + R * rng.standard_normal((len(t), *SHAPE))) / N
    step = float(rng.uniform(0.5, 1) / N)
    measured = E * t < 1
    measured[0] = True
    return (
        step * np.maximum(np.round(X / step), 1),
        np.full(X.shape, step),
        measured,
        times,
        N,
        R,
    ), E


def get_answer(subject, inputs):
    """Return the student's E and s, for a read noise of R electrons, passed as on the sheet."""
    X, D, measured, t, N, R = inputs
    noise = R
    E, spread = parts(subject.inverse_variance_merge(X, D, measured, t, N, noise), 2)
    s = finite(spread, SHAPE, what="s").astype(float)
    return finite(E, SHAPE, what="E").astype(float), s


def alike(answer, expected, tolerance, what, unit=1.0):
    same(answer / unit, expected / unit, tolerance, what=what, picture=True)


def is_valid_input(X, D, measured, t, *_, **__):
    """Return whether every pixel is measured in some frame."""
    return bool(measured.any(axis=0).all())


@points(2)
def test_a_single_photo_keeps_its_own_noise(subject, rng):
    """With one photo, the mean is its own value, X / t.

    The variance of X / t is the variance of X divided by t^2.

    s is a standard deviation: the square root of V = variance(X, D, N, R) / t^2.
    """
    inputs, _ = counted(rng, np.array([float(rng.uniform(3, 6))]), dimmest=20.0)
    X, D, _, t, N, R = inputs
    E, s = get_answer(subject, inputs)
    alike(E, X[0] / t, 1e-3, "E / (X / t)", X[0] / t)
    truth = np.sqrt(variance(X[0], D[0], N, R)) / t
    alike(s, truth, 0.02, "s / the standard deviation of one photo", truth)


@points(2)
def test_equal_exposure_times_give_the_plain_mean(subject, rng):
    """Four photos have the same scene and the same time. By chance, one of them caught more photons
    than the others.

    Chance is no reason to give it a smaller weight. V depends on the true light, which is the same
    in all four.

    Compute V from E t, once you know E, and not from the count of each photo. Then all weights are
    equal.
    """
    inputs, _ = counted(rng, np.full(4, 2.0), dimmest=20.0)
    X, D, _, _, N, R = inputs
    E, s = get_answer(subject, inputs)
    plain = X.mean(axis=0) / 2
    alike(E, plain, 0.005, "E / the plain mean", plain)
    truth = np.sqrt(variance(2 * plain, D[0], N, R)) / 4
    alike(s, truth, 0.02, "s / half the standard deviation of one photo", truth)


@points(2)
def test_a_photo_that_does_not_measure_a_pixel_is_ignored(subject, rng):
    """Where `measured` is False, the value in X is not a measurement.

    Leave such a photo out of all sums.

    Set its V to infinity: then 1 / V is 0.
    """
    (X, D, measured, *rest), _ = counted(rng)
    before = get_answer(subject, (X, D, measured, *rest))
    D = np.where(measured, D, 1e-4)
    E, s = get_answer(subject, (np.where(measured, X, 0.5), D, measured, *rest))
    alike(E, before[0], 1e-3, "E after changing unmeasured values / E before", before[0])
    alike(s, before[1], 1e-3, "s after changing unmeasured values / s before", before[1])


@points(9)
def test_each_measurement_is_weighted_by_its_inverse_variance(subject, rng):
    """The longest unclipped photo is the most certain one. How much do the others count?

    The weight of a measurement x = X / t is 1 / V, where V = variance(E t, D, N, R) / t^2 is the
    variance of x.

    E = sum(x / V) / sum(1 / V), and s^2 = 1 / sum(1 / V).
    """
    inputs, _ = counted(rng)
    E, s = get_answer(subject, inputs)
    truth = inverse_variance_merge(*inputs)
    alike(E, truth[0], 0.05, "E, in standard deviations", truth[1])
    alike(s, truth[1], 0.05, "s / the correct s", truth[1])


@points(7)
def test_no_other_mean_has_a_smaller_error(subject, rng):
    """Compare your E with the true scene: its error must be as small as possible.

    Does the longest unclipped photo have the largest weight? Also in the dark?

    Any weights other than 1 / V make the error of E larger.
    """
    inputs, scene = counted(rng)
    best, s = inverse_variance_merge(*inputs)
    smallest_error, answer = (
        np.sqrt(np.mean(((E - scene) / s) ** 2)) for E in (best, get_answer(subject, inputs)[0])
    )
    same(
        max(answer / smallest_error, 1.0),
        1.0,
        0.02,
        what="root mean square error / the smallest possible",
    )


@points(2)
def test_95_percent_of_the_pixels_lie_within_1_96_standard_deviations(subject, rng):
    """If s is right, the true scene lies within E +- 1.96 s for 95 % of the pixels.

    Are too many pixels outside? Then V lacks a term. Too few? Then s belongs to one photo and not
    to the mean.

    Several photos together are more certain than one: s^2 = 1 / sum(1 / V).
    """
    inputs, scene = counted(rng)
    E, s = get_answer(subject, inputs)
    same(
        100 * np.mean(np.abs(E - scene) < 1.96 * s),
        95.0,
        3.0,
        what="percentage of pixels within 1.96 s",
    )
