"""Robertson's irradiance: irradiance(Z, t, f_inv, w) -> E (N,)."""

import numpy as np

from hdrlab.core import weights
from hdrlab.course.checks.compare import finite, points, same
from hdrlab.response import robertson

HAT = weights.hat()


def drawn(rng, N=300, P=4):
    """Return Z (N, P), t (P,) and a rising f^-1 (256,)."""
    return rng.integers(0, 256, (N, P)), rng.uniform(0.1, 2, P), np.sort(rng.uniform(0.01, 2, 256))


def test_every_sample_has_an_irradiance(subject, rng):
    """One number for each sample, and not for each frame.

    Sum over the frames, which are the second axis of Z.

    The answer is E (N,).
    """
    Z, t, f_inv = drawn(rng)
    finite(subject.irradiance(Z.clip(20, 230), t, f_inv, HAT), (300,), what="E")


@points(4)
def test_it_is_the_weighted_mean_of_the_slide(subject, rng):
    """Divide one sum by another, both over the frames.

    Above stands sum w f^-1 t: the time is there too.

    E = sum_j w f^-1(Z_ij) t_j / sum_j w t_j^2, the time squared below.
    """
    Z, t, f_inv = drawn(rng)
    truth, seen = robertson.irradiance(Z, t, f_inv, HAT), HAT[Z].sum(axis=1) > 0.05
    same(subject.irradiance(Z, t, f_inv, HAT), truth, 2e-3 * np.nanmax(truth), what="E", where=seen)


@points(3)
def test_frames_that_agree_give_what_they_agree_on(subject, rng):
    """Where every frame says the same E, the mean is that E.

    f^-1(Z_ij) = E_i t_j in every frame: put that into your formula.

    Weights and times must cancel: what stands above must stand below with f^-1 = E t divided by E.
    """
    f_inv, t = np.arange(256) / 128.0, np.array([1.0, 2.0, 4.0])
    x = rng.integers(3, 60, 50)
    Z = np.stack([x, 2 * x, 4 * x], axis=1)
    same(subject.irradiance(Z, t, f_inv, HAT), x / 128, 1e-4, what="E")


@points(2)
def test_twice_the_time_is_half_the_irradiance(subject, rng):
    """Twice the time for the same photographs is half the light.

    Replace t by 2 t in the quotient.

    The time stands once above, and squared below.
    """
    Z, t, f_inv = drawn(rng)
    truth, seen = robertson.irradiance(Z, t, f_inv, HAT), HAT[Z].sum(axis=1) > 0.05
    same(
        subject.irradiance(Z, 2 * t, f_inv, HAT),
        truth / 2,
        1e-3 * np.nanmax(truth),
        what="E",
        where=seen,
    )


def test_a_sample_that_no_frame_saw_well_is_nan(subject, rng):
    """What is known of a sample that is clipped in all frames?

    Nothing: 0 / 0.

    NaN is the number that says so; 0 would be a dark hole.
    """
    _, t, f_inv = drawn(rng)
    Z = np.array([[0, 0, 255, 255], [100, 150, 200, 250]])
    expected = [np.nan, robertson.irradiance(Z[1:], t, f_inv, HAT)[0]]
    same(subject.irradiance(Z, t, f_inv, HAT), expected, 1e-3 * expected[1], what="E")
