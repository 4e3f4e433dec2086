"""Checks of ev(F, T, S), the exposure value in stops."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same


def test_every_setting_has_a_finite_value(subject, rng):
    """Return the number; do not print it.

    For an array of settings, return an array of values.

    Use numpy's logarithm.
    """
    T = 2.0 ** rng.uniform(-10, 3, 5)
    finite(subject.ev(8.0, T), (5,), what="EV of five times")


@points(4)
def test_twice_the_f_number_is_two_stops_and_half_the_time_is_one(subject, rng):
    """EV 0 is f/1 for one second.

    EV = 2 log2 F - log2 T at ISO 100.

    f/8 is 6 stops from f/1, because 2 log2 8 = 6.
    """
    same(subject.ev(1.0, 1.0), 0.0, 1e-4, what="EV of f/1 and 1 s")
    same(subject.ev(8.0, 1 / 64), 12.0, 1e-4, what="EV of f/8 and 1/64 s")
    F = float(rng.uniform(1.4, 16))
    T = float(2.0 ** rng.uniform(-10, 3))
    same(subject.ev(F, T), np.log2(F * F / T), 1e-4, what=f"EV of f/{F:.3g} and {T:.3g} s")


@points(3)
def test_twice_the_speed_lowers_the_value_by_one(subject, rng):
    """At twice the speed, half the light is enough.

    With the same aperture and time, a scene for ISO 400 is 2 stops darker than one for ISO 100.

    Subtract log2(S / 100).
    """
    F = float(rng.uniform(1.4, 16))
    T = float(2.0 ** rng.uniform(-10, 3))
    for n in (-1, 1, 3):
        same(
            subject.ev(F, T, S=100.0 * 2**n),
            np.log2(F * F / T) - n,
            1e-4,
            what=f"EV at ISO {100 * 2**n:g}",
        )


@points(3)
def test_a_bracket_of_times_gives_one_value_each(subject, rng):
    """The settings can be arrays.

    Use numpy's functions, not those of math.

    np.log2 works on each value of an array.
    """
    T = 2.0 ** rng.uniform(-10, 3, 7)
    same(subject.ev(5.6, T), np.log2(5.6**2 / T), 1e-4, what="EV")
