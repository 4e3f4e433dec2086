"""The same exposure with other settings: equivalent_time(T, F, F_new, S, S_new) -> seconds."""

import numpy as np

from hdrlab.course.checks.compare import points, same


def drawn(rng):
    """Return T, F, F_new, S, S_new: neither speed is the other, nor twice it."""
    F, F_new = rng.uniform(1.4, 22, 2)
    S, S_new = np.array([100, 160]) * 2.0 ** rng.integers(0, 6, 2)
    return float(2.0 ** rng.uniform(-10, 2)), float(F), float(F_new), float(S), float(S_new)


@points(4)
def test_two_stops_of_aperture_are_four_times_the_time(subject, rng):
    """A larger f-number is a smaller hole: does your time become longer?

    The light goes with the area of the hole, 1 / F^2.

    T' = T (F' / F)^2.
    """
    same(subject.equivalent_time(1 / 64, 8.0, 16.0), 1 / 16, 1e-6, what="T'")
    T, F, F_new, _, _ = drawn(rng)
    same(
        subject.equivalent_time(T, F, F_new) / T,
        (F_new / F) ** 2,
        1e-4 * (F_new / F) ** 2,
        what="T' / T",
    )


@points(3)
def test_twice_the_speed_is_half_the_time(subject, rng):
    """Twice the speed needs half the time.

    T' is longer where the new speed is lower.

    Multiply by S / S'.
    """
    T, F, _, S, S_new = drawn(rng)
    came = subject.equivalent_time(T, F, F, S=S, S_new=2 * S_new)
    same(came / T, S / (2 * S_new), 1e-4 * S / S_new, what="T' / T")


@points(3)
def test_there_and_back_is_the_time_one_began_with(subject, rng):
    """Change the settings, and change them back.

    What you multiply by on the way must be what you divide by on the way back.

    T' = T (F' / F)^2 S / S'.
    """
    T, F, F_new, S, S_new = drawn(rng)
    there, exposure = float(subject.equivalent_time(T, F, F_new, S=S, S_new=S_new)), T * S / F**2
    same(
        there * S_new / F_new**2,
        exposure,
        1e-4 * exposure,
        what="T' S' / F'^2, which is the exposure",
    )
    back = subject.equivalent_time(there, F_new, F, S=S_new, S_new=S)
    same(back / T, np.array(1.0), 1e-4, what="the time after the way back, over that before")
