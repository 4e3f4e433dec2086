"""Brightness transfer by matching ranks, for photos of any size; NaN for ranks without a partner."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from hdrlab.core import transfer
from hdrlab.errors import InputError


def test_the_transfer_of_a_photo_to_itself_is_the_identity():
    h = np.random.default_rng(0).integers(1, 50, 256)
    T = transfer.brightness_transfer(h, h)
    assert np.allclose(T[1:-1], np.arange(1, 255)) and np.isnan(T[[0, -1]]).all()
    assert np.allclose(transfer.literal_transfer(h, h), np.arange(256))


@given(k=st.integers(2, 6))
def test_for_uniform_light_the_transfer_of_a_linear_camera_is_a_line_and_the_literal_one_is_offset(
    k,
):
    """A linear camera and evenly distributed light: T = k m.

    The paper's literal method gives k m + (k - 1) / 2.
    """
    light = (np.arange(200_000) + 0.5) / 200_000 * 240
    h = [np.bincount(np.floor(light * s + 0.5).astype(int), minlength=256) for s in (1 / k, 1)]
    m = np.arange(2, 220 // k)
    assert np.allclose(transfer.brightness_transfer(*h)[m], k * m, atol=0.01)
    assert np.allclose(transfer.literal_transfer(*h)[m], k * m + (k - 1) / 2, atol=0.01)


@given(st.integers(0, 99), st.booleans())
def test_a_transfer_never_falls_and_does_not_depend_on_the_pixel_count(seed, sparse):
    rng = np.random.default_rng(seed)
    h_A, h_B = rng.integers(0, 2 if sparse else 90, (2, 256)) + np.eye(256, dtype=int)[[9, 200]]
    for way in (transfer.literal_transfer, transfer.brightness_transfer):
        T = way(h_A, h_B)
        assert np.all(np.diff(T[np.isfinite(T)]) >= 0)
        assert np.allclose(way(3 * h_A, h_B), T, equal_nan=True)


def test_levels_that_no_pixel_has_are_transferred_to_nan():
    h_A, h_B = np.zeros((2, 256), int)
    h_A[40:90] = 10
    h_B[80:180] = 5
    T = transfer.brightness_transfer(h_A, h_B)
    assert np.isnan(T[:40]).all() and np.isnan(T[90:]).all()
    assert np.allclose(T[40:90], 2 * np.arange(40, 90) + 0.5)


@pytest.mark.parametrize("bad", [np.zeros(256), -np.ones(256), np.ones(16), np.ones((2, 256))])
def test_invalid_histograms_raise_an_error(bad):
    for way in (transfer.literal_transfer, transfer.brightness_transfer):
        with pytest.raises(InputError):
            way(bad, np.ones(256))


def test_histograms_count_each_channel_over_the_pixels_that_are_valid_in_every_frame():
    images = np.zeros((2, 2, 2, 3), np.uint8)
    images[0, ..., 1] = 7
    images[1, 0, 0] = 9
    valid = np.ones((2, 2, 2), bool)
    valid[1, 1, 1] = False
    h = transfer.histograms(images, valid)
    assert h.shape == (3, 2, 256) and np.all(h.sum(axis=-1) == 3)
    assert h[1, 0, 7] == 3 and h[0, 1, 9] == 1 and h[2, 0, 0] == 3
    assert transfer.histograms(images[..., 0].astype(np.uint16) * 257).shape == (1, 2, 65536)
