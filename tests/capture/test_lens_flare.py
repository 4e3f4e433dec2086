"""A lens that scatters light: how much a pixel loses, and where the light goes."""

import numpy as np
import pytest

from hdrlab.capture.lens_flare import add_glare
from hdrlab.core.filters.scatter import GlareSpread

RNG = np.random.default_rng(0)


def test_a_clean_lens_does_not_change_the_image():
    E = RNG.lognormal(size=(6, 7, 3)).astype(np.float32)
    assert np.array_equal(add_glare(E, GlareSpread(0)), E)


def test_a_lamp_loses_the_glare_fraction_and_lifts_the_dark_less_at_a_distance():
    E = np.zeros((21, 31), np.float32)
    E[10, 15] = 1000
    F = add_glare(E, GlareSpread(0.1))
    assert F[10, 15] == pytest.approx(900, rel=1e-5)
    row = F[10, 16:]
    assert np.all(np.diff(row) < 0) and row[-1] > 0
    assert F.sum() <= 1000 * (1 + 1e-5)  # some light leaves the frame, none is made


def test_glare_is_proportional_to_light_and_the_same_for_each_channel():
    E = RNG.lognormal(size=(9, 8, 3)).astype(np.float32)
    assert np.allclose(add_glare(4 * E), 4 * add_glare(E), rtol=1e-5)
    assert np.allclose(add_glare(E)[..., 1], add_glare(E[..., 1]), rtol=1e-5)


def test_a_glare_fraction_of_1_raises_an_error():
    with pytest.raises(ValueError, match="fraction"):
        add_glare(np.ones((3, 3)), GlareSpread(1))
