"""The code of BT.2100's PQ: pq(FD) -> v, from cd/m2 to a signal of 0 to 1."""

import numpy as np

from hdrlab.course.checks.compare import points, same
from hdrlab.tonemap import transfer


@points(5)
def test_a_luminance_has_the_code_of_the_standard(subject, rng):
    """Is it the curve of the standard? 100 cd/m2 has the signal 0.508.

    Y is FD over 10,000, and m1 is about 1/6. The quotient is raised to m2, which is about 79, last.

    v = ((c1 + c2 Y^m1) / (1 + c3 Y^m1))^m2.
    """
    FD = np.sort(10 ** rng.uniform(-3, 3, 200))
    same(subject.pq(FD), transfer.pq(FD), 1e-4, what="v", kind="curve")


@points(3)
def test_the_white_of_an_old_display_lies_in_the_middle(subject, rng):
    """Where do 10,000 and 100 cd/m2, and none at all, get their codes?

    The largest luminance has the largest signal, 1: then Y is 1, and c1 + c2 = 1 + c3.

    Without light Y is 0, and c1^m2 is as good as 0.
    """
    FD = rng.permutation([0.0, 100.0, 10_000.0, 10_000.0])
    same(
        subject.pq(FD),
        np.interp(FD, [0, 100, 10_000], [0, 0.508, 1]),
        1e-3,
        what="v of black and whites",
    )


@points(2)
def test_a_picture_is_coded_pixel_by_pixel(subject, rng):
    """A picture has rows, columns and channels. What does each of them change?

    Every number has its own code.

    Work on the whole array at once, and keep its shape.
    """
    FD = 10 ** rng.uniform(0, 3, (8, 12, 3))
    same(subject.pq(FD), transfer.pq(FD), 1e-4, what="v of a picture")
