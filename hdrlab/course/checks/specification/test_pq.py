"""Checks of pq(FD), the PQ code of BT.2100: v, a signal from 0 to 1 for luminance in cd/m2."""

import numpy as np

from hdrlab.course.checks.compare import points, same
from hdrlab.tonemap import transfer


def is_valid_input(FD):
    """Return whether all luminances are above 0, where the signal is not a tiny number."""
    return bool((FD > 0).all())


@points(5)
def test_a_luminance_has_the_code_of_the_standard(subject, rng):
    """Is your curve that of the standard? The signal of 100 cd/m2 is 0.508.

    Y is FD / 10,000. The power m1, about 1/6, comes first; the power m2, about 79, comes last.

    v = ((c1 + c2 Y^m1) / (1 + c3 Y^m1))^m2.
    """
    FD = np.sort(10 ** rng.uniform(-3, 3, 200))
    same(subject.pq(FD), transfer.pq(FD), 1e-4, what="v", kind="curve")


@points(3)
def test_black_100_and_10000_have_the_signals_of_the_standard(subject, rng):
    """What are the signals of 0, 100 and 10,000 cd/m2?

    10,000 cd/m2 has the signal 1: there Y = 1, and c1 + c2 = 1 + c3.

    At 0 cd/m2, Y = 0, and the signal is c1^m2, almost 0.
    """
    FD = rng.permutation([0.0, 100.0, 10_000.0, 10_000.0])
    same(
        subject.pq(FD),
        np.interp(FD, [0, 100, 10_000], [0, 0.508, 1]),
        1e-3,
        what="v of 0, 100 and 10,000 cd/m2",
    )


@points(2)
def test_every_value_of_an_image_is_coded_by_itself(subject, rng):
    """An image has rows, columns and channels. Does your function keep its shape?

    The signal of a value does not depend on other values.

    Compute with the whole array at once, and return an array of the same shape.
    """
    FD = 10 ** rng.uniform(0, 3, (8, 12, 3))
    same(subject.pq(FD), transfer.pq(FD), 1e-4, what="v of an image")
