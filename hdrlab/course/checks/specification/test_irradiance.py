"""Checks of irradiance(Z, t, f_inv, w), Robertson's irradiance: E (N,)."""

import numpy as np

from hdrlab.core import weights
from hdrlab.course.checks.compare import finite, points, same
from hdrlab.response import robertson

HAT = weights.hat()


def draw_inputs(rng, N=300, P=4):
    """Return Z (N, P), t (P,) and an increasing f^-1 (256,)."""
    Z = rng.integers(0, 256, (N, P)).astype(np.intp)
    return Z, rng.uniform(0.1, 2, P), np.sort(rng.uniform(0.01, 2, 256))


def test_every_sample_has_an_irradiance(subject, rng):
    """Return one number per sample, not one per frame.

    Sum over the frames, the second axis of Z.

    The result is E (N,).
    """
    Z, t, f_inv = draw_inputs(rng)
    finite(subject.irradiance(Z.clip(20, 230), t, f_inv, HAT), (300,), what="E")


@points(4)
def test_it_is_the_weighted_mean_of_the_slides(subject, rng):
    """Divide one sum over the frames by another one.

    The numerator is the sum of w f^-1(Z) t. Do not forget t.

    E = sum_j w f^-1(Z_ij) t_j / sum_j w t_j^2. The denominator has the square of the time.
    """
    Z, t, f_inv = draw_inputs(rng)
    truth = robertson.irradiance(Z, t, f_inv, HAT)
    seen = HAT[Z].sum(axis=1) > 0.05
    same(subject.irradiance(Z, t, f_inv, HAT), truth, 2e-3 * np.nanmax(truth), what="E", where=seen)


@points(3)
def test_frames_that_agree_give_their_common_value(subject, rng):
    """If every frame gives the same E, the mean must be this E.

    Put f^-1(Z_ij) = E_i t_j into your formula.

    The numerator must become E times the denominator, so that weights and times cancel.
    """
    f_inv = np.arange(256) / 128.0
    t = np.array([1.0, 2.0, 4.0])
    x = rng.integers(3, 60, 50)
    Z = np.stack([x, 2 * x, 4 * x], axis=1)
    same(subject.irradiance(Z, t, f_inv, HAT), x / 128, 1e-4, what="E")


@points(2)
def test_twice_the_time_gives_half_the_irradiance(subject, rng):
    """The same pixel values at twice the time mean half the light.

    Replace t by 2 t in your formula. Does the result become half as large?

    The numerator has t, and the denominator has t^2.
    """
    Z, t, f_inv = draw_inputs(rng)
    truth = robertson.irradiance(Z, t, f_inv, HAT)
    seen = HAT[Z].sum(axis=1) > 0.05
    same(
        subject.irradiance(Z, 2 * t, f_inv, HAT),
        truth / 2,
        1e-3 * np.nanmax(truth),
        what="E",
        where=seen,
    )


def test_a_sample_without_any_weight_is_nan(subject, rng):
    """What do you know about a sample that is clipped in all frames?

    Nothing: the formula gives 0 / 0.

    Return NaN for it. A 0 would look like a dark spot.
    """
    _, t, f_inv = draw_inputs(rng)
    Z = np.array([[0, 0, 255, 255], [100, 150, 200, 250]])
    expected = [np.nan, robertson.irradiance(Z[1:], t, f_inv, HAT)[0]]
    same(subject.irradiance(Z, t, f_inv, HAT), expected, 1e-3 * expected[1], what="E")
