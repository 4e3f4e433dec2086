"""hdrlab.fast._lookup: a curve read for every pixel, against np.interp."""

import numpy as np
import pytest

from hdrlab.fast import _lookup as lookup


@pytest.mark.parametrize("n", [1, 2, 100])
def test_values_are_interpolated_between_knots_and_constant_beyond_them(n):
    rng = np.random.default_rng(n)
    knots = rng.standard_normal(n + 1)
    t = rng.uniform(-2, n + 2, (40, 50)).astype(np.float32)
    read = lookup.interpolate(lookup.tabulate(knots), t)
    assert np.allclose(read, np.interp(t, np.arange(n + 1), knots), atol=1e-5)
    assert read.dtype == np.float32


def test_values_at_knots_are_exact():
    knots = np.float32([3, -1, 4, 1, 5])
    assert np.array_equal(lookup.interpolate(lookup.tabulate(knots), np.arange(5)), knots)
