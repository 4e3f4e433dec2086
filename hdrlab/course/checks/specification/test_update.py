"""Robertson's new inverse response: update(Z, t, E, n) -> f^-1 (n,)."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same
from hdrlab.response import robertson


def drawn(rng, N=4000, P=4):
    """Return Z (N, P), t (P,) and E (N,), all levels occupied."""
    Z = rng.integers(0, 256, (N, P))
    return Z, rng.uniform(0.1, 2, P), rng.uniform(0.2, 3, N)


def test_every_level_has_a_response(subject, rng):
    """One number for each level.

    The answer is f^-1 (256,), whatever levels the samples have.

    np.bincount with minlength=n counts and sums by level.
    """
    Z, t, E = drawn(rng)
    finite(subject.update(Z, t, E), (256,), what="f^-1")


@points(4)
def test_each_level_gets_the_mean_exposure_of_its_pixels(subject, rng):
    """For each level m: which samples in which frames have it?

    The new f^-1(m) is the mean of E_i t_j over these.

    Divide by how many there are of this level, not by the number of samples.
    """
    Z, t, E = drawn(rng)
    same(subject.update(Z, t, E), robertson.update(Z, t, E), 2e-3, what="f^-1", kind="curve")


@points(3)
def test_the_mean_is_a_plain_one(subject):
    """Does it matter in your mean whether m is close to the ends of the range?

    All pixels of E_m have one level, hence one weight; the exposures of a level are averaged as
    they are.

    A plain mean: no table of weights, no time squared.
    """
    Z, t, E = (
        np.array([[7, 200], [200, 7], [7, 7]]),
        np.array([1.0, 2.0]),
        np.array([3.0, 5.0, 4.0]),
    )
    expected = np.full(256, np.nan)
    expected[7], expected[200] = (3 * 1 + 5 * 2 + 4 * 1 + 4 * 2) / 4, (3 * 2 + 5 * 1) / 2
    told = ~np.isnan(expected)
    same(subject.update(Z, t, E), expected, 1e-4, what="f^-1 at the levels 7 and 200", where=told)


@points(2)
def test_a_sample_without_irradiance_is_left_out(subject, rng):
    """What is an E that is NaN worth in a sum?

    A sample without irradiance tells nothing of f^-1, and must not spoil the others.

    Leave out the rows of Z where E is NaN.
    """
    Z, t, E = drawn(rng)
    more, nan = np.concatenate([Z, Z[:50]]), np.concatenate([E, np.full(50, np.nan)])
    same(subject.update(more, t, nan), robertson.update(Z, t, E), 2e-3, what="f^-1", kind="curve")


def test_a_level_without_pixels_is_nan(subject, rng):
    """Which f^-1 has a level that no pixel has?

    Nobody knows yet: 0 / 0.

    NaN now; the next step fills it from its neighbours.
    """
    Z, t, E = drawn(rng)
    Z = Z // 2 * 2
    same(subject.update(Z, t, E, n=256), robertson.update(Z, t, E), 2e-3, what="f^-1", kind="curve")
