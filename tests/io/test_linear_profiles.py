"""Linear light of pixels with a color profile, by the published curves and primaries."""

import numpy as np
import pytest

from hdrlab.core import colour, gamut
from hdrlab.errors import InputError
from hdrlab.io import profiles

# Exponent, and x, y of red, green, blue and white [Adobe RGB (1998), 4.3].
ADOBE_GAMMA = 563 / 256
ADOBE_PRIMARIES = (0.64, 0.33, 0.21, 0.71, 0.15, 0.06, 0.3127, 0.3290)
# Profiles store curves and colorants in 16 bits.
TOLERANCE = 1e-3


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_adobe_rgb_becomes_light_by_its_own_curve_and_primaries(dtype):
    largest = np.iinfo(dtype).max
    pixels = np.random.default_rng(0).integers(0, largest + 1, (20, 30, 3)).astype(dtype)
    linear = profiles.to_linear("x.jpg", pixels, profiles.ADOBE)
    expected = (pixels / largest) ** ADOBE_GAMMA
    assert linear.light.dtype == np.float32
    assert np.allclose(linear.light, expected, atol=TOLERANCE)
    assert np.allclose(linear.to_srgb, gamut.conversion_matrix(ADOBE_PRIMARIES), atol=TOLERANCE)


def test_colors_outside_srgb_are_negative_and_not_clipped():
    green = np.uint8([[[0, 255, 0]]])
    linear = profiles.to_linear("x.jpg", green, profiles.DISPLAY_P3)
    in_srgb = linear.to_srgb @ linear.light[0, 0]
    expected = gamut.conversion_matrix(gamut.WIDE["p3"]) @ [0, 1, 0]
    assert expected[0] < -0.2
    assert in_srgb == pytest.approx(expected, abs=TOLERANCE)


def test_pixels_without_a_profile_and_gray_ones_are_those_of_srgb():
    pixels = np.arange(24, dtype=np.uint8).reshape(2, 4, 3)
    for linear, values in (
        (profiles.to_linear("x.jpg", pixels, b""), pixels),
        (profiles.to_linear("x.jpg", pixels[..., 0], profiles.DISPLAY_P3), pixels[..., 0]),
    ):
        assert np.allclose(linear.light, colour.decode_srgb(values / 255))
        assert np.array_equal(linear.to_srgb, np.eye(3))


def test_damaged_profiles_are_rejected_by_name():
    with pytest.raises(InputError, match=r"x\.jpg.*profile"):
        profiles.to_linear("x.jpg", np.zeros((2, 2, 3), np.uint8), b"no profile")
