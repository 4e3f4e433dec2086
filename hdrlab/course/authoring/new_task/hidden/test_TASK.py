"""Checks that students do not see. They, too, may require only what the assignment says."""

import numpy as np

from hdrlab.course.checks.compare import points, same


@points(2)
def test_integers_do_not_overflow(subject, rng):
    """The pixel values may be 8-bit integers.

    The product of 200 and 150 does not fit into eight bits.

    Convert the pixel values to float first.
    """
    Z, flat = rng.integers(100, 250, (2, 12, 16)).astype(np.uint8)
    same(subject.TASK(Z, flat), Z * (flat.mean() / flat), 0.1, what="corrected", picture=True)
