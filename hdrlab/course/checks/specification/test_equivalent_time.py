"""Checks of equivalent_time(T, F, F_new, S, S_new): the time with the same exposure, in seconds."""

import numpy as np

from hdrlab.course.checks.compare import points, same


def draw_inputs(rng):
    """Return T, F, F_new, S, S_new. No speed equals another one or is twice another one."""
    F, F_new = rng.uniform(1.4, 22, 2)
    S, S_new = np.array([100, 160]) * 2.0 ** rng.integers(0, 6, 2)
    return float(2.0 ** rng.uniform(-10, 2)), float(F), float(F_new), float(S), float(S_new)


@points(4)
def test_two_stops_of_aperture_are_four_times_the_time(subject, rng):
    """A larger f-number is a smaller aperture. Does your time become longer?

    The light is proportional to the area of the aperture, 1 / F^2.

    T' = T (F' / F)^2.
    """
    same(subject.equivalent_time(1 / 64, 8.0, 16.0), 1 / 16, 1e-6, what="T'")
    T, F, F_new, _, _ = draw_inputs(rng)
    same(
        subject.equivalent_time(T, F, F_new) / T,
        (F_new / F) ** 2,
        1e-4 * (F_new / F) ** 2,
        what="T' / T",
    )


@points(3)
def test_twice_the_speed_needs_half_the_time(subject, rng):
    """At twice the speed, half the time is enough.

    T' must be longer if the new speed is lower.

    Multiply by S / S'.
    """
    T, F, _, S, S_new = draw_inputs(rng)
    answer = subject.equivalent_time(T, F, F, S=S, S_new=2 * S_new)
    same(answer / T, S / (2 * S_new), 1e-4 * S / S_new, what="T' / T")


@points(3)
def test_changing_the_settings_back_restores_the_time(subject, rng):
    """Change the settings and change them back: do you get the first time again?

    The factor on the way back must be the inverse of the factor on the way there.

    T' = T (F' / F)^2 S / S'.
    """
    T, F, F_new, S, S_new = draw_inputs(rng)
    there = float(subject.equivalent_time(T, F, F_new, S=S, S_new=S_new))
    exposure = T * S / F**2
    same(
        there * S_new / F_new**2,
        exposure,
        1e-4 * exposure,
        what="the new exposure, T' S' / F'^2",
    )
    back = subject.equivalent_time(there, F_new, F, S=S_new, S_new=S)
    same(back / T, np.array(1.0), 1e-4, what="the time after changing back / the first time")
