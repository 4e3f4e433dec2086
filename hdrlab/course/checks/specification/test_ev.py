"""Exposure value: ev(F, T, S) -> stops."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same


def test_every_setting_has_a_finite_value(subject, rng):
    """Return the number, do not print it.

    Arrays of settings give arrays of values.

    Use numpy's logarithm.
    """
    T = 2.0 ** rng.uniform(-10, 3, 5)
    finite(subject.ev(8.0, T), (5,), what="EV of five times")


@points(4)
def test_a_whole_aperture_and_half_the_time_are_a_stop_each(subject, rng):
    """EV 0 is f/1 for one second.

    EV = 2 log2 F - log2 T at ISO 100.

    f/8 is three times 2 stops from f/1: 2 log2 8 = 6.
    """
    same(subject.ev(1.0, 1.0), 0.0, 1e-4, what="EV of f/1 and 1 s")
    same(subject.ev(8.0, 1 / 64), 12.0, 1e-4, what="EV of f/8 and 1/64 s")
    F, T = float(rng.uniform(1.4, 16)), float(2.0 ** rng.uniform(-10, 3))
    same(subject.ev(F, T), np.log2(F * F / T), 1e-4, what=f"EV of f/{F:.3g} and {T:.3g} s")


@points(3)
def test_twice_the_speed_takes_a_stop(subject, rng):
    """Twice the speed needs half the light.

    A scene that suits ISO 400 at some setting is 2 stops darker than one that suits ISO 100 at the
    same.

    Subtract log2(S / 100).
    """
    F, T = float(rng.uniform(1.4, 16)), float(2.0 ** rng.uniform(-10, 3))
    for n in (-1, 1, 3):
        same(
            subject.ev(F, T, S=100.0 * 2**n),
            np.log2(F * F / T) - n,
            1e-4,
            what=f"EV at ISO {100 * 2**n:g}",
        )


@points(3)
def test_a_bracket_of_times_gives_a_value_each(subject, rng):
    """The settings may be arrays.

    Use numpy's functions, not those of math.

    np.log2 works value by value.
    """
    T = 2.0 ** rng.uniform(-10, 3, 7)
    same(subject.ev(5.6, T), np.log2(5.6**2 / T), 1e-4, what="EV")
