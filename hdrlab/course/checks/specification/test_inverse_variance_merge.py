"""The surest mean: inverse_variance_merge(X, D, measured, t, N, R) -> E and s, each (H, W)."""

import numpy as np

from hdrlab.course.checks.compare import finite, parts, points, same
from hdrlab.radiance.uncertainty import inverse_variance_merge, variance

TIMES, SHAPE = np.array([1.0, 4.0, 16.0]), (30, 40)


def counted(rng, times=TIMES, dimmest=2.0):
    """Return what a linear camera counts, as a student gets it, and the true radiance."""
    N, R = float(rng.uniform(800, 1200)), float(rng.uniform(2, 4))
    E = np.exp(rng.uniform(np.log(dimmest / N), np.log(0.2), SHAPE))
    t = times[:, None, None]
    X = (rng.poisson(E * t * N) + R * rng.standard_normal((len(t), *SHAPE))) / N
    step, measured = float(rng.uniform(0.5, 1) / N), E * t < 1
    measured[0] = True
    return (
        step * np.maximum(np.round(X / step), 1),
        np.full(X.shape, step),
        measured,
        times,
        N,
        R,
    ), E


def asked(subject, given):
    """Return E and s of a student."""
    E, s = parts(subject.inverse_variance_merge(*given), 2)
    return finite(E, SHAPE, what="E").astype(float), finite(s, SHAPE, what="s").astype(float)


def alike(came, expected, tolerance, what, unit=1.0):
    same(came / unit, expected / unit, tolerance, what=what, picture=True)


@points(2)
def test_one_photograph_alone_is_as_sure_as_its_own_noise(subject, rng):
    """Of one photograph the mean is its own answer, X / t.

    The variance of X / t is that of X over the square of t.

    s is a standard deviation: the root of a variance, V = variance(X, D, N, R) / t^2.
    """
    given, _ = counted(rng, np.array([float(rng.uniform(3, 6))]), dimmest=20.0)
    (X, D, _, t, N, R), (E, s) = given, asked(subject, given)
    alike(E, X[0] / t, 1e-3, "E over X / t", X[0] / t)
    true = np.sqrt(variance(X[0], D[0], N, R)) / t
    alike(s, true, 0.02, "s over that of one photograph", true)


@points(2)
def test_of_equal_times_it_is_the_plain_mean(subject, rng):
    """Four photographs of one light and one time. One of them caught more photons than the others, by chance.

    Chance is no reason to count it for less. V is that of the light which is there, the same in all
    four.

    Take V from E t, once E is known, and not from what each photograph counted; then the weights
    are equal.
    """
    given, _ = counted(rng, np.full(4, 2.0), dimmest=20.0)
    (X, D, _, _, N, R), (E, s) = given, asked(subject, given)
    plain = X.mean(axis=0) / 2
    alike(E, plain, 0.005, "E over the plain mean", plain)
    true = np.sqrt(variance(2 * plain, D[0], N, R)) / 4
    alike(s, true, 0.02, "s over half that of one photograph", true)


@points(2)
def test_a_photograph_that_does_not_measure_a_pixel_has_no_say_in_it(subject, rng):
    """Where `measured` is False, what stands in X is no measurement.

    Such a photograph is missing in all of the sums.

    Let its V be infinite: then 1 / V is 0.
    """
    (X, D, measured, *rest), _ = counted(rng)
    before, D = asked(subject, (X, D, measured, *rest)), np.where(measured, D, 1e-4)
    E, s = asked(subject, (np.where(measured, X, 0.5), D, measured, *rest))
    alike(E, before[0], 1e-3, "E with other values there, over E before", before[0])
    alike(s, before[1], 1e-3, "s with other values there, over s before", before[1])


@points(9)
def test_each_answer_counts_by_the_inverse_of_its_variance(subject, rng):
    """The longest photograph knows most, if it is not clipped. How much do the others count beside it?

    An answer x = X / t counts by 1 / V, V the variance of x: V = variance(E t, D, N, R) / t^2.

    E = sum (x / V) / sum (1 / V), and s^2 = 1 / sum (1 / V).
    """
    given, _ = counted(rng)
    (E, s), true = asked(subject, given), inverse_variance_merge(*given)
    alike(E, true[0], 0.05, "E, in standard deviations", true[1])
    alike(s, true[1], 0.05, "s over what it should be", true[1])


@points(7)
def test_no_other_mean_errs_less(subject, rng):
    """A mean is as good as its errors are small. Hold yours against the scene that was photographed.

    Is the longest photograph that is not clipped the one that counts most? And in the dark?

    Weights other than 1 / V make the error of each pixel larger, more or less, in units of s.
    """
    given, scene = counted(rng)
    best, s = inverse_variance_merge(*given)
    least, came = (
        np.sqrt(np.mean(((E - scene) / s) ** 2)) for E in (best, asked(subject, given)[0])
    )
    same(max(came / least, 1.0), 1.0, 0.02, what="root mean square error, over the least")


@points(2)
def test_of_100_pixels_95_lie_within_1_96_deviations(subject, rng):
    """To say E +- 1.96 s is to say something that can be wrong: hold it against the scene.

    Too many outside: is something left out of V? Too few: is s that of the mean, or of one answer?

    Three photographs of one light know more than one: s^2 = 1 / sum (1 / V).
    """
    given, scene = counted(rng)
    E, s = asked(subject, given)
    same(
        100 * np.mean(np.abs(E - scene) < 1.96 * s), 95.0, 3.0, what="pixels within 1.96 s, of 100"
    )
