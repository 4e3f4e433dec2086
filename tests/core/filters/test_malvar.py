"""Demosaicing by gradient-corrected interpolation."""

import numpy as np
import pytest

from hdrlab.core.filters import malvar, mosaic
from hdrlab.errors import InputError

PATTERNS = {
    "RGGB": [[0, 1], [1, 2]],
    "BGGR": [[2, 1], [1, 0]],
    "GRBG": [[1, 0], [2, 1]],
    "GBRG": [[1, 2], [0, 1]],
}


def demosaic_image(E, pattern):
    c = mosaic.tile(pattern, E.shape[:2])
    return malvar.demosaic(mosaic.sample(E, c), c)


@pytest.mark.parametrize("pattern", PATTERNS.values(), ids=PATTERNS)
@pytest.mark.parametrize("shape", [(8, 8), (7, 5), (2, 2)])
def test_a_uniform_gray_is_reconstructed_up_to_the_edge(pattern, shape):
    E = np.full((*shape, 3), 0.4)
    assert np.allclose(demosaic_image(E, pattern), E)


@pytest.mark.parametrize("pattern", PATTERNS.values(), ids=PATTERNS)
def test_a_uniform_color_is_reconstructed_up_to_the_edge(pattern):
    E = np.ones((8, 10, 3)) * [0.2, 0.5, 0.9]
    assert np.allclose(demosaic_image(E, pattern), E)


@pytest.mark.parametrize("pattern", PATTERNS.values(), ids=PATTERNS)
def test_linear_ramps_with_another_slope_in_each_channel_are_exact_inside(pattern):
    y, x = np.mgrid[:12, :14] / 20
    E = np.stack([x, y, 2 * x - y + 1], axis=-1)
    assert np.allclose(demosaic_image(E, pattern)[2:-2, 2:-2], E[2:-2, 2:-2])


def test_measured_channels_stay_as_they_are():
    X = np.random.default_rng(0).random((9, 11))
    c = mosaic.tile(mosaic.BAYER, X.shape)
    assert np.array_equal(mosaic.sample(malvar.demosaic(X, c), c), X)


# By the package colour-demosaicing 0.2.7, demosaicing_CFA_Bayer_Malvar2004, of the mosaic
# (37 y^2 + 61 x + 17 x y^2) mod 101 of 8 x 8 pixels: rows 2 to 3, columns 2 to 5
OF_COLOUR_DEMOSAICING = {
    "RGGB": [
        [[2, 42.25, 17], [4.75, 30, 42.8125], [58, 81.25, 93.875], [67.0625, 86, 94.4375]],
        [[18.5, 54, 60.3125], [28.3125, 59.875, 66], [44.4375, 78, 96.9375], [79.5, 79.5, 90]],
    ],
    "GRBG": [
        [[20.9375, 2, 48.5625], [30, 23.875, 30.1875], [64.3125, 58, 62.3125], [86, 75.5, 75.5]],
        [[37.4375, 31.125, 54], [72.5, 66, 84.9375], [88.625, 76, 78], [98.4375, 90, 71.0625]],
    ],
}


@pytest.mark.parametrize("name", OF_COLOUR_DEMOSAICING)
def test_malvars_result_equals_that_of_colour_demosaicing(name):
    y, x = np.mgrid[:8, :8]
    X = (37.0 * y**2 + 61 * x + 17 * x * y**2) % 101
    E = malvar.demosaic(X, mosaic.tile(PATTERNS[name], X.shape))
    assert np.allclose(E[2:4, 2:6], OF_COLOUR_DEMOSAICING[name])


@pytest.mark.parametrize(
    "channels",
    [
        np.zeros((4, 4), int),
        np.tile([[0, 1], [2, 1]], (2, 2)),
        np.tile([[0, 1], [1, 0]], (2, 2)),
        np.kron([[0, 1], [1, 2]], np.ones((2, 2), int)),
        np.array([[0, 1, 0, 1]]),
    ],
    ids=["one color", "stripes of green", "two colors", "cells of four pixels", "one row"],
)
def test_channels_that_are_no_bayer_pattern_are_rejected(channels):
    with pytest.raises(InputError):
        malvar.demosaic(np.ones(channels.shape), channels)
