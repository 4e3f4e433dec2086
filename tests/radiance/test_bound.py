"""Bounds on the radiance of pixels that no photo measures."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from hdrlab.radiance.merge import Quality, bound
from hdrlab.response.linear import curve

G = curve()
TOP = 250
B = np.log([1.0, 4.0, 16.0])


def answer(*levels, shown=(True, True, True)):
    """Return the radiance and the flag of one pixel in three frames of 1, 4 and 16 seconds."""
    E, flags = bound(np.array(levels)[:, None], B, G, TOP, np.array(shown)[:, None])
    return E[0], flags[0]


@pytest.mark.parametrize(
    ("levels", "shown", "E", "flag"),
    [
        ((255, 255, 255), (1, 1, 1), TOP / 128, Quality.CLIPPED),
        ((250, 251, 252), (1, 1, 1), TOP / 128, Quality.CLIPPED),
        ((255, 255, 255), (0, 1, 1), TOP / 128 / 4, Quality.CLIPPED),
        ((255, 255, 255), (0, 0, 1), TOP / 128 / 16, Quality.CLIPPED),
        ((0, 0, 0), (1, 1, 1), 1 / 128 / 16, Quality.DARK),
        ((0, 0, 0), (1, 1, 0), 1 / 128 / 4, Quality.DARK),
        ((0, 0, 255), (1, 1, 1), np.sqrt(TOP / 16 * 1 / 4) / 128, Quality.CLIPPED | Quality.DARK),
        ((0, 255, 255), (1, 1, 1), np.sqrt(TOP / 4 * 1) / 128, Quality.CLIPPED | Quality.DARK),
        ((0, 0, 255), (1, 1, 0), 1 / 128 / 4, Quality.DARK),
        ((0, 0, 255), (0, 0, 0), 0, Quality.UNSEEN),
    ],
)
def test_the_tightest_bound_of_the_frames_that_show_a_pixel_is_taken(levels, shown, E, flag):
    bound, quality = answer(*levels, shown=np.array(shown, bool))
    assert np.isclose(bound, E, rtol=1e-12) and quality == flag


@given(st.lists(st.sampled_from([0, 250, 255]), min_size=3, max_size=3))
def test_bounds_are_positive_and_flagged(levels):
    E, flag = answer(*levels)
    assert np.isfinite(E)
    assert E > 0
    assert flag in (Quality.CLIPPED, Quality.DARK, Quality.CLIPPED | Quality.DARK)
