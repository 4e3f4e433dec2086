"""Coded exposure: which shutter codes can be inverted, and how much a coded photo improves deblurring."""

import numpy as np
import pytest
from skimage import data

from hdrlab.beyond import flutter
from hdrlab.core.colour import decode_srgb
from hdrlab.errors import InputError

CODE = flutter.RASKAR_CODE
BOX = flutter.box(52)
ONE = np.eye(52)[0]  # open for one chop of 52
SIGMA = 0.0005


def thing():
    """Return an image, 200 pixels long in the direction of motion, and so bright that noise is never
    clipped at 0.
    """
    return 0.2 + 0.8 * decode_srgb(data.coffee()[100:228, 200:400, 1].T / 255.0)


def rms(x, truth):
    return float(np.sqrt(np.mean((x - truth) ** 2)))


def photographed(h, *, seed=0, **knobs):
    knobs = {"sigma": SIGMA, "bits": 16, **knobs}
    return flutter.expose(thing(), h, rng=np.random.default_rng(seed), **knobs)


def test_the_code_has_52_chops_half_of_them_open():
    assert len(CODE) == 52 and CODE.sum() == 26


def test_a_box_shutter_has_zeros_in_its_transfer_and_the_code_has_none():
    assert flutter.transfer(BOX).min() < 1e-3 and flutter.transfer(CODE).min() > 0.025
    # 1, 2, ... waves in 52 chops: a box lets none of them through
    whole_waves = np.abs(np.fft.fft(BOX))[1:]
    assert whole_waves.max() < 1e-12


def test_the_transfer_of_one_chop_is_flat_and_that_of_a_box_is_the_dirichlet_kernel():
    assert np.allclose(flutter.transfer(ONE), 1 / 52)
    w = np.linspace(0, np.pi, 4096)[1:]
    assert np.allclose(
        flutter.transfer(BOX)[1:], np.abs(np.sin(26 * w) / np.sin(w / 2)) / 52, atol=1e-12
    )


def test_smear_equals_the_matrix_product_and_a_convolution():
    x = np.random.default_rng(0).random(30)
    assert np.allclose(flutter.smear(x, CODE), np.convolve(x, CODE) / 52)
    assert np.allclose(flutter.matrix(CODE, 30) @ x, flutter.smear(x, CODE))


@pytest.mark.parametrize("h", [CODE, BOX, ONE, [1, 0, 1, 1]])
def test_without_noise_sharpen_inverts_smear_for_any_shutter(h):
    x = np.random.default_rng(1).random((80, 3))
    assert np.allclose(flutter.sharpen(flutter.smear(x, h), h), x, atol=1e-9)


def test_sharpen_works_after_subtracting_the_background():
    x = thing()
    behind = np.linspace(0, 0.3, 251)[:, None]
    y = flutter.smear(x, CODE) + behind
    assert np.allclose(flutter.sharpen(y - behind, CODE), x, atol=1e-9)


def test_with_noise_the_code_is_three_times_better_than_a_short_exposure_and_a_box_is_worse():
    code_error = rms(flutter.sharpen(photographed(CODE), CODE), thing())
    short_error = rms(flutter.sharpen(photographed(ONE), ONE), thing())
    box_error = rms(flutter.sharpen(photographed(BOX), BOX), thing())
    assert 2.5 < short_error / code_error < 3.5
    assert box_error > short_error


@pytest.mark.parametrize("h", [CODE, ONE])
def test_noise_grows_by_the_amplification(h):
    n = len(thing())
    error = rms(flutter.sharpen(photographed(h), h), thing()) / SIGMA
    assert error == pytest.approx(flutter.amplification(h), rel=0.08)
    assert flutter.amplification(BOX) == np.inf and n == 200


def test_one_coded_photo_is_as_clean_as_the_mean_of_nearly_nine_short_ones():
    assert flutter.equivalent_pictures(CODE) == pytest.approx(8.7, abs=0.05)
    assert flutter.equivalent_pictures(ONE) == 1
    coded = rms(flutter.sharpen(photographed(CODE), CODE), thing())
    shorts = np.stack([photographed(ONE, seed=k) for k in range(12)])
    means = [rms(flutter.sharpen(shorts[:n].mean(axis=0), ONE), thing()) for n in range(1, 13)]
    assert means[6] > coded > means[10]  # worse than 11 short ones, better than 7
    assert (
        abs(1 + int(np.argmin(np.abs(np.array(means) - coded))) - flutter.equivalent_pictures(CODE))
        < 1.5
    )


def test_a_bracket_of_two_coded_photos_is_as_clean_as_one_of_many_short_ones():
    """An object with a lamp: the highlights come from the small gain, the shadows from the large one."""
    x = thing().copy()
    x[90:110, 50:70] = 8.0
    small = 1 / 4
    large = 1.0

    def radiance(h, gains, seed):
        knobs = dict(sigma=SIGMA, bits=16, rng=np.random.default_rng(seed))
        y = [flutter.expose(x, h, gain=gain, **knobs) for gain in gains]
        return flutter.sharpen(flutter.combine(y, gains), h)

    gains = [small, large]
    dark = (slice(None), slice(90, None))  # columns that the lamp does not cross
    coded = rms(radiance(CODE, gains, 1)[dark], x[dark])
    short = rms(radiance(ONE, gains, 1)[dark], x[dark])
    many = rms(radiance(ONE, gains * 9, 1)[dark], x[dark])
    assert coded < short / 2.5 and coded == pytest.approx(many, rel=0.15)
    assert rms(radiance(CODE, gains, 1)[90:110, 50:70], 8.0) < 0.3


def test_combine_leaves_out_full_pixels():
    x = np.array([0.1, 0.6, 3.0])
    joined = flutter.combine([np.minimum(x, 1), x / 4], [1.0, 0.25])
    assert np.allclose(joined, x)
    assert flutter.combine([[1.0], [1.0]], [1.0, 0.25]) == 4.0  # full in both: at least this much


@pytest.mark.parametrize(
    "call",
    [
        lambda: flutter.as_code([0, 0]),
        lambda: flutter.as_code([0, 2]),
        lambda: flutter.as_code([[1]]),
        lambda: flutter.sharpen([1.0, 2.0], [1, 0, 1]),
        lambda: flutter.sharpen([1.0, np.nan, 2.0], [1, 1]),
        lambda: flutter.combine([[1.0]], [1.0, 2.0]),
        lambda: flutter.combine([[1.0]], [0.0]),
    ],
)
def test_invalid_arguments_raise_an_error(call):
    with pytest.raises(InputError):
        call()


def test_combine_weights_photos_by_the_square_of_their_gain():
    combined = flutter.combine([[[0.1, 0.4, 1.0]], [[0.6, 1.0, 1.0]]], [1, 4])
    assert combined[0] == pytest.approx([(0.1 + 16 * 0.6 / 4) / 17, 0.4, 1.0])
