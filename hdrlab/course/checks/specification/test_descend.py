"""Checks of descend(T, start, low), a series of pixel values by repeated comparison: (K,)."""

import numpy as np

from hdrlab.course.checks.compare import numbers, points, require, same
from hdrlab.response.mann import descend


def draw_inputs(rng, *, first=0, last=255):
    """Return T (256,), which is known from `first` to `last`: a curved camera's, with alpha and ripples."""
    z = np.arange(256.0)
    gamma = rng.uniform(0.4, 0.6)
    T = 255 * (z / 255) ** rng.uniform(1.05, 1.15) * 2.0**-gamma + 0.4 * np.sin(z / 9)
    T[: first + 1] = np.where(np.arange(first + 1) < first, np.nan, T[first])
    T[last + 1 :] = np.nan
    return T


def same_series(subject, T, start, low, what="the series"):
    """Compare a series with the library's, which may be longer than the student's in no place."""
    expected = descend(T, start, low=low)
    answer = numbers(subject.descend(T, start, low=low), what=what).astype(float).ravel()
    require(
        len(answer) == len(expected),
        f"{what}: expected {len(expected)} values, got {len(answer)}",
        expected=expected,
    )
    same(answer, expected, 1e-2, what=what, kind="values")


def safe(T, start, low):
    """Return whether rounding errors decide nothing about where a series ends."""
    series = descend(T, start, low=low)
    below = np.interp(series[-1], np.arange(256), T)
    steps = np.append(series[:-1] - series[1:], series[-1] - below)
    steps = steps[np.isfinite(steps)]
    ends = np.append(series, below if np.isfinite(below) else series[-1])
    return np.all(np.abs(steps - 0.5) > 0.03) and np.all(np.abs(ends - low) > 0.1)


def clear_start(rng, T, low):
    """Return a start between two pixel values, from which all decisions are clear."""
    while True:
        start = float(rng.integers(200, 240) + rng.uniform(0.3, 0.7))
        if safe(T, start, low):
            return start


@points(4)
def test_each_value_is_the_one_below_in_the_dark_photo(subject, rng):
    """A pixel has the value M in the bright photo. Which value does it have in the dark one?

    T(M). Look for a pixel that has this value in the bright photo, and ask again.

    The series is start, T(start), T(T(start)), and so on. Begin with start itself.
    """
    T = np.round(draw_inputs(rng))
    same_series(subject, T, float(rng.integers(215, 250)), 40.5)


@points(5)
def test_between_two_values_t_is_a_straight_line(subject, rng):
    """T(200) and T(201) are known, and the series is at 200.4. What is T there?

    Interpolate: T(200.4) = 0.6 T(200) + 0.4 T(201).

    numpy.interp does this. Do not round the values of the series.
    """
    T = draw_inputs(rng)
    low = 30.0
    same_series(subject, T, clear_start(rng, T, low), low)


@points(3)
def test_the_series_ends_above_the_lowest_useful_value(subject, rng):
    """Which values can be used for a logarithm?

    Those of at least `low`: below, rounding and noise dominate.

    Compare the next value with `low` before you append it.
    """
    T = draw_inputs(rng)
    for low in (80.0, float(rng.integers(20, 40))):
        same_series(subject, T, clear_start(rng, T, low), low, what=f"the series down to {low:g}")


@points(4)
def test_the_series_ends_where_t_is_not_known(subject, rng):
    """T is NaN where the dark photo is too dark or the bright one is clipped. What follows from it?

    Nothing: the series ends with the value of which T is not known.

    Test whether the last value lies between the first and the last pixel value with a known T.
    """
    T = draw_inputs(rng, first=int(rng.integers(90, 120)), last=240)
    same_series(subject, T, clear_start(rng, T, 12.0), 12.0)
    answer = numbers(subject.descend(T, 247.5, low=12.0), what="a series that starts above T")
    same(answer, [247.5], 1e-9, what="a series that starts where T is not known")


@points(2)
def test_the_series_ends_where_the_values_hardly_fall(subject, rng):
    """The two photos have nearly the same exposure, or T has a fixed point. Does your loop end?

    A step of less than half a pixel value is rounding, and no difference of exposure.

    Append the next value only if it is at least 0.5 below the last one.
    """
    z = np.arange(256.0)
    fixed = float(rng.integers(60, 90))
    T = fixed + rng.uniform(0.55, 0.65) * (z - fixed)
    same_series(subject, T, clear_start(rng, T, 12.0), 12.0, what="the series toward a fixed point")
