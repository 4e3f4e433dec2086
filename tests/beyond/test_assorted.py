"""Assorted pixels: the range that one photo with several exposures gains, and the resolution it loses."""

import numpy as np
import pytest
from skimage import data
from skimage.metrics import peak_signal_noise_ratio

from hdrlab import scenes
from hdrlab.beyond import assorted
from hdrlab.core.colour import decode_srgb, encode_srgb
from hdrlab.core.filters import mosaic
from hdrlab.errors import InputError

WELL = dict(full_well=20_000, read_noise=5)
SHAPE = (64, 64)
FOUR = mosaic.tile(assorted.FOUR_EXPOSURES, SHAPE)


def error(L, e, *, sigma=0.5, seed=0):
    """Return the relative RMS error of a uniform surface of luminance L."""
    Z = assorted.shoot(np.full(SHAPE, L), e, bits=16, rng=seed, **WELL)
    return np.sqrt(np.mean((assorted.reconstruct(Z, e, sigma=sigma, **WELL) / L - 1) ** 2))


def ends(e, *, sigma=0.5, most=0.1):
    """Return log10 of the darkest and brightest light that is reconstructed within 10 %."""
    L = np.geomspace(1e-4, 300, 100)
    good = np.array([error(light, e, sigma=sigma) < most for light in L])
    return np.log10(L[good][[0, -1]])


def photograph():
    return decode_srgb(data.coffee()[100:300, 150:400] / 255.0)


def psnr(E, truth):
    """Return the PSNR of the pictures that a display would show, 1 = white."""
    shown = [encode_srgb(np.clip(light, 0, 1)) for light in (truth, E)]
    return peak_signal_noise_ratio(*shown, data_range=1)


def tones(E, truth):
    """Return the PSNR of log light over four decades, which weights bright and dark pixels equally."""
    log = [np.log10(np.clip(light, 1e-3, 10)) for light in (truth, E)]
    return peak_signal_noise_ratio(*log, data_range=4)


def test_four_exposures_two_stops_apart_add_six_stops():
    assert assorted.added_decades(FOUR) == pytest.approx(np.log10(64))


def test_the_range_grows_at_the_bright_end_by_added_decades():
    assert ends(FOUR)[1] - ends(np.ones(SHAPE))[1] == pytest.approx(
        assorted.added_decades(FOUR), abs=0.05
    )


def test_compared_with_single_pixels_the_whole_range_grows_by_added_decades():
    """A single shot read pixel by pixel; averaging neighbors compensates for the dark filters."""
    single = ends(np.ones(SHAPE), sigma=1e-3)
    four = ends(FOUR)
    assert np.diff(four) - np.diff(single) == pytest.approx(assorted.added_decades(FOUR), abs=0.12)


def test_compared_with_an_equally_blurred_shot_a_quarter_of_a_decade_is_lost_in_the_dark():
    assert ends(FOUR)[0] - ends(np.ones(SHAPE))[0] == pytest.approx(0.25, abs=0.08)


def test_pixels_that_are_full_behind_all_filters_get_the_lower_bound():
    E = assorted.reconstruct(assorted.shoot(np.full(SHAPE, 1e6), FOUR), FOUR)
    assert np.allclose(E, 64)


@pytest.mark.parametrize("L", [0.01, 0.5, 3, 10, 50])
def test_a_uniform_surface_is_reconstructed_at_any_level(L):
    assert error(L, FOUR) < 0.1
    noiseless = assorted.reconstruct(assorted.shoot(np.full(SHAPE, L), FOUR, bits=16), FOUR)
    assert np.allclose(noiseless, L, rtol=2e-3)


def test_the_mosaic_has_each_color_behind_each_filter_equally_often():
    c, e = assorted.colours_and_exposures()
    for channel, count in ((0, 2), (1, 4), (2, 2)):
        assert np.sort(e[c == channel]).tolist() == [0.25] * count + [1.0] * count


def test_a_uniform_color_is_reconstructed():
    colors, exposures = assorted.colours_and_exposures((1.0, 1 / 16))
    c = mosaic.tile(colors, SHAPE)
    e = mosaic.tile(exposures, SHAPE)
    E = np.ones((*SHAPE, 3)) * [3.0, 0.2, 9.0]
    back = assorted.reconstruct(assorted.shoot(E, e, c, bits=16), e, c)
    assert np.allclose(back, E, rtol=5e-3)


def test_plain_demosaicing_is_better_for_an_ordinary_scene():
    """Nothing is clipped here; the price of assorted pixels is sharpness."""
    E = photograph() * 0.9
    c = mosaic.tile(mosaic.BAYER, E.shape[:2])
    plain = mosaic.demosaic(assorted.shoot(E, np.ones(E.shape[:2]), c, bits=16, **WELL) / 65535, c)
    colors, exposures = assorted.colours_and_exposures()
    c = mosaic.tile(colors, E.shape[:2])
    e = mosaic.tile(exposures, E.shape[:2])
    mixed = assorted.reconstruct(assorted.shoot(E, e, c, bits=16, **WELL), e, c, **WELL)
    assert psnr(plain, E) > psnr(mixed, E) + 1


def test_assorted_pixels_are_better_for_a_scene_too_wide_for_one_exposure():
    """25.6 dB instead of 21.3 dB, for the logarithm of light over four decades."""
    E = scenes.workshop()[::2, ::2].astype(np.float64)
    E = E / np.quantile(E, 0.8)  # a fifth of the picture is full
    c = mosaic.tile(mosaic.BAYER, E.shape[:2])
    plain = mosaic.demosaic(assorted.shoot(E, np.ones(E.shape[:2]), c, bits=16, **WELL) / 65535, c)
    colors, exposures = assorted.colours_and_exposures((1.0, 1 / 64))
    c = mosaic.tile(colors, E.shape[:2])
    e = mosaic.tile(exposures, E.shape[:2])
    mixed = assorted.reconstruct(assorted.shoot(E, e, c, bits=16, **WELL), e, c, **WELL)
    assert tones(mixed, E) > tones(plain, E) + 4


def waves(frequency, level, e, *, length=256):
    """Return the spectrum of the reconstruction of a horizontal wave of this frequency and level."""
    x = np.arange(length)
    E = level * (1 + 0.5 * np.cos(2 * np.pi * frequency * x)) * np.ones((16, 1))
    e = mosaic.tile(e, E.shape)
    back = assorted.reconstruct(assorted.shoot(E, e, bits=16), e)[8]
    return np.abs(np.fft.rfft(back / level)) / length * 4  # of the wave itself: 1


@pytest.mark.parametrize("level", [0.3, 20.0])
def test_a_wave_below_the_sampling_limit_is_reconstructed(level):
    seen = waves(16 / 256, level, assorted.FOUR_EXPOSURES)
    assert seen[16] > 0.75 and np.delete(seen, [0, 16]).max() < 0.12


def test_a_fine_wave_is_aliased_where_only_dark_filters_measure():
    """If only every second column is usable, 112 waves in 256 pixels look like 16; on a plain sensor
    they do not.
    """
    plain = waves(112 / 256, 0.3, np.ones((2, 2)))
    strong = waves(112 / 256, 40.0, assorted.FOUR_EXPOSURES)
    assert plain[16] < 0.01 and plain[112] > 0.5 and strong[16] > 0.9 and strong[112] < 0.1


@pytest.mark.parametrize(
    "call",
    [
        lambda: assorted.shoot(np.ones(SHAPE), np.ones((3, 3))),
        lambda: assorted.shoot(np.ones(SHAPE), np.zeros(SHAPE)),
        lambda: assorted.shoot(np.ones((*SHAPE, 3)), FOUR),
        lambda: assorted.shoot(np.ones(SHAPE), FOUR, bits=12),
        lambda: assorted.shoot(np.ones(SHAPE), FOUR, full_well=0),
        lambda: assorted.reconstruct(np.ones(SHAPE), FOUR),
        lambda: assorted.reconstruct(np.ones(SHAPE, np.uint8), FOUR, np.full(SHAPE, 5)),
        lambda: assorted.reconstruct(np.ones(SHAPE, np.uint8), FOUR[:4]),
    ],
)
def test_invalid_arguments_raise_an_error(call):
    with pytest.raises(InputError):
        call()


def test_a_weight_is_the_inverse_of_the_variance_of_rounding_photons_and_readout():
    Z = np.array([51, 255], np.uint8)
    e = np.array([2.0, 2.0])
    assert assorted.weight(Z, e) == pytest.approx([4 * 12 * 255**2, 0])
    noise = 0.2 / 1000 + (5 / 1000) ** 2 + 1 / (12 * 255**2)
    assert assorted.weight(Z, e, full_well=1000, read_noise=5)[0] == pytest.approx(4 / noise)
    quiet = 0.2 / 1000 + 1 / (12 * 255**2)
    assert assorted.weight(Z, e, full_well=1000)[0] == pytest.approx(4 / quiet)
