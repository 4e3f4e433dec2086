"""hdrlab.core.picture: statistics of an image."""

import numpy as np
import pytest

from hdrlab.core.picture import gray, statistics


def test_a_half_black_half_white_image_has_an_entropy_of_one_bit():
    picture = np.repeat(np.uint8([0, 255]), 50).reshape(10, 10)
    result = statistics(picture)
    assert result == pytest.approx((0.5, 0.5, 127.5, 127.5, 1.0))
    assert statistics(np.stack([picture] * 3, axis=-1)) == pytest.approx(result, abs=1e-4)


def test_the_entropy_is_8_bits_if_every_level_occurs_once_and_0_for_a_constant():
    assert statistics(np.arange(256, dtype=np.uint8).reshape(16, 16)).entropy == pytest.approx(8)
    assert statistics(np.full((3, 4), 7, np.uint8)) == (0, 0, 7, 0, 0)


def test_a_pixel_is_white_if_any_channel_is_255_and_black_if_all_are_0():
    result = statistics(np.uint8([[[255, 0, 0], [0, 0, 0], [0, 0, 1], [254, 254, 254]]]))
    assert result.white == 0.25 and result.black == 0.25


def test_gray_weighs_the_channels_as_luminance_does():
    assert gray(np.uint8([[[0, 100, 0], [255, 255, 255]]])) == pytest.approx(
        np.array([[71.52, 255]])
    )


@pytest.mark.parametrize("shape", [(4,), (4, 5, 2), (0, 5), (1, 4, 5, 3)])
def test_invalid_images_raise_an_error(shape):
    with pytest.raises(ValueError, match="picture"):
        statistics(np.zeros(shape, np.uint8))
    with pytest.raises(ValueError, match="uint8"):
        statistics(np.zeros((4, 5)))
