"""Checks of offset(average, target, a, c), the light to add to a photo: a number of stops."""

from hdrlab.course.checks.compare import points, same
from hdrlab.enhance import relight


def same_offset(subject, average, target=128.0, **shape):
    expected = relight.offset(average, target, **shape)
    answer = subject.offset(average, target, **shape)
    same(answer, expected, 2e-3, what=f"the offset from {average:.4g} to {target:.4g}, in stops")


@points(4)
def test_the_offset_is_the_difference_of_two_amounts_of_light(subject, rng):
    """Which light q makes a pixel of value Y? Solve Y = f(q) for q.

    (255 / Y)^(1 / C) = 1 + e^(-A q).

    q = -ln((255 / Y)^(1 / C) - 1) / A. Subtract the q of the average from that of the target.
    """
    for low, high in ((30, 90), (150, 230)):
        same_offset(subject, float(rng.uniform(low, high)))


@points(2)
def test_the_target_can_be_another_value_than_128(subject, rng):
    """Where should the average end up?

    At the target. 128 is only its default.

    Put the target into f^-1.
    """
    same_offset(subject, float(rng.uniform(40, 100)), float(rng.uniform(150, 190)))


@points(3)
def test_the_curve_has_the_shape_of_a_and_c(subject, rng):
    """A and C shape the curve. Which cameras do they describe?

    Any: the defaults are only one camera.

    Use `a` and `c` wherever the formula has A and C.
    """
    shape = {"a": float(rng.uniform(0.9, 1.4)), "c": float(rng.uniform(0.4, 0.9))}
    same_offset(subject, float(rng.uniform(40, 100)), **shape)


@points(3)
def test_the_offset_is_at_most_8_stops(subject, rng):
    """The average is black. How much light would be needed?

    Infinitely much. No photo shows anything after more than 8 stops.

    Clip the result to -8 ... 8, also where f^-1 is infinite.
    """
    for average in (0.0, 255.0):
        same_offset(subject, average)
    same_offset(subject, float(rng.uniform(0.01, 0.05)), 200.0, a=0.5, c=0.8)
