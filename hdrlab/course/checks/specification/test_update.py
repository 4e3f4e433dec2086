"""Checks of update(Z, t, E, n), Robertson's new inverse response: f^-1 (n,)."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same
from hdrlab.response import robertson


def draw_inputs(rng, N=4000, P=4):
    """Return Z (N, P), t (P,) and E (N,), with pixels at all levels."""
    Z = rng.integers(0, 256, (N, P)).astype(np.intp)
    return Z, rng.uniform(0.1, 2, P), rng.uniform(0.2, 3, N)


def test_every_level_has_a_response(subject, rng):
    """Return one number for each pixel value.

    The result is f^-1 (256,), even if the samples do not have all pixel values.

    np.bincount with minlength=n counts and sums by pixel value.
    """
    Z, t, E = draw_inputs(rng)
    finite(subject.update(Z, t, E), (256,), what="f^-1")


@points(4)
def test_each_level_gets_the_mean_exposure_of_its_pixels(subject, rng):
    """For each pixel value m: which samples in which frames have this pixel value?

    The new f^-1(m) is the mean of E_i t_j over these pixels.

    Divide by the number of pixels of this value, not by the number of samples.
    """
    Z, t, E = draw_inputs(rng)
    same(subject.update(Z, t, E), robertson.update(Z, t, E), 2e-3, what="f^-1", kind="curve")


@points(3)
def test_the_mean_has_no_weights(subject):
    """Do you weight the pixels of a pixel value?

    All pixels of one value have the same weight, so the mean does not need weights.

    Use the plain mean of E_i t_j: no weights, and no squared time.
    """
    Z = np.array([[7, 200], [200, 7], [7, 7]])
    t = np.array([1.0, 2.0])
    E = np.array([3.0, 5.0, 4.0])
    expected = np.full(256, np.nan)
    expected[7] = (3 * 1 + 5 * 2 + 4 * 1 + 4 * 2) / 4
    expected[200] = (3 * 2 + 5 * 1) / 2
    has_value = ~np.isnan(expected)
    same(
        subject.update(Z, t, E),
        expected,
        1e-4,
        what="f^-1 at the levels 7 and 200",
        where=has_value,
    )


@points(2)
def test_a_sample_without_irradiance_is_left_out(subject, rng):
    """What does an E of NaN do to a sum?

    A sample without irradiance must not change the result.

    Leave out the rows of Z where E is NaN.
    """
    Z, t, E = draw_inputs(rng)
    more = np.concatenate([Z, Z[:50]])
    nan = np.concatenate([E, np.full(50, np.nan)])
    same(subject.update(more, t, nan), robertson.update(Z, t, E), 2e-3, what="f^-1", kind="curve")


def test_a_level_without_pixels_is_nan(subject, rng):
    """What is f^-1 at a pixel value that no pixel has?

    It is 0 / 0.

    Return NaN there. The next step interpolates it.
    """
    Z, t, E = draw_inputs(rng)
    Z = Z // 2 * 2
    same(subject.update(Z, t, E, n=256), robertson.update(Z, t, E), 2e-3, what="f^-1", kind="curve")
