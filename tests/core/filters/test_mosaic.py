"""Color filter mosaics and demosaicing."""

import cv2
import numpy as np
import pytest

from hdrlab.core.filters import mosaic
from hdrlab.errors import InputError


def filters(shape):
    return mosaic.tile(mosaic.BAYER, shape)


def test_a_pattern_repeats_and_is_cut_at_the_edge():
    assert mosaic.tile([[0, 1], [1, 2]], (3, 5)).tolist() == [
        [0, 1, 0, 1, 0],
        [1, 2, 1, 2, 1],
        [0, 1, 0, 1, 0],
    ]


def test_half_of_a_bayer_sensor_is_green():
    assert np.bincount(filters((8, 8)).ravel()).tolist() == [16, 32, 16]


def test_each_pixel_sees_the_channel_of_its_filter():
    E = np.stack(np.broadcast_arrays(1.0, 2.0, 3.0), axis=-1) * np.ones((4, 6, 1))
    assert np.array_equal(mosaic.sample(E, filters((4, 6))), filters((4, 6)) + 1)


@pytest.mark.parametrize("shape", [(8, 8), (7, 5), (2, 2)])
def test_a_uniform_color_is_reconstructed_up_to_the_edge(shape):
    E = np.ones((*shape, 3)) * [0.2, 0.5, 0.9]
    assert np.allclose(mosaic.demosaic(mosaic.sample(E, filters(shape)), filters(shape)), E)


def test_a_gradient_is_reconstructed_inside():
    y, x = np.mgrid[:12, :14] / 20
    E = np.stack([x, y, x + y], axis=-1)
    back = mosaic.demosaic(mosaic.sample(E, filters((12, 14))), filters((12, 14)))
    assert np.allclose(back[1:-1, 1:-1], E[1:-1, 1:-1])


def test_demosaicing_equals_opencvs_bilinear_interpolation_inside():
    Z = np.random.default_rng(3).integers(0, 65536, (40, 52), dtype=np.uint16)
    theirs = cv2.cvtColor(Z, cv2.COLOR_BayerRGGB2RGB)
    ours = mosaic.demosaic(Z, filters(Z.shape))
    assert np.abs(ours - theirs)[2:-2, 2:-2].max() <= 0.5  # they round


def test_invalid_mosaics_raise_an_error():
    for call in (
        lambda: mosaic.tile([0, 1], (4, 4)),
        lambda: mosaic.tile(mosaic.BAYER, (0, 4)),
        lambda: mosaic.sample(np.ones((4, 4)), filters((4, 4))),
        lambda: mosaic.sample(np.ones((4, 4, 3)), filters((4, 6))),
        lambda: mosaic.demosaic(np.ones((4, 4)), np.full((4, 4), 3)),
    ):
        with pytest.raises(InputError):
            call()
