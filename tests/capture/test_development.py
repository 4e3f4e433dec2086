"""Development of a RAW photo, on mosaics of a simulated camera whose scene is known."""

import numpy as np
import pytest

from hdrlab import scenes
from hdrlab.capture import development, sensor
from hdrlab.capture.sensor import Sensor
from hdrlab.core import colour
from hdrlab.core.filters import malvar, mosaic
from hdrlab.errors import InputError
from hdrlab.io import raw

PATTERNS = {
    "RGGB": [[0, 1], [1, 2]],
    "BGGR": [[2, 1], [1, 0]],
    "GRBG": [[1, 0], [2, 1]],
    "GBRG": [[1, 2], [0, 1]],
}
# XYZ to the channels of the Canon EOS 5D Mark III, as dcraw and LibRaw have it
CANON = np.array([[0.6722, -0.0635, -0.0963], [-0.4287, 1.2460, 0.2028], [-0.0908, 0.2162, 0.5668]])
CANON_OF_SRGB = CANON @ development.XYZ_OF_SRGB
GAINS = sensor.balance(CANON_OF_SRGB.sum(axis=1))
CONVERSION = development.screen_from_camera(CANON, development.XYZ_OF_SRGB)
SENSOR = Sensor(full_well=40_000, read_noise=4, gain=2.5, bits=14, black=512)
FULL_LEVEL = 512 + 15871  # the converter ends below the full well
NUMBERS = dict(black=512, white=FULL_LEVEL, gains=GAINS, conversion=CONVERSION)


def in_neutral_light(place, shape=(192, 288)):
    """Return a scene (H, W, 3), linear sRGB, with a gray mean; one pixel in a thousand exceeds 1."""
    E = getattr(scenes, place)(shape)
    E = E / E.mean(axis=(0, 1))
    return (E / np.quantile(E, 0.999)).astype(np.float32)


def photograph(E, pattern, *, seed=0, full=1.0):
    """Return the RAW levels (H, W) of linear sRGB in a Canon camera; gray of E = 1 reaches `full` in
    green.
    """
    camera = np.maximum(E @ CANON_OF_SRGB.T / CANON_OF_SRGB.sum(axis=1).max(), 0)
    X = mosaic.sample(camera, mosaic.tile(pattern, E.shape[:2]))
    exposure = np.float32(full * (FULL_LEVEL - 512) * SENSOR.gain / SENSOR.full_well) * X
    return sensor.read(exposure.astype(np.float32), SENSOR, rng=np.random.default_rng(seed))


def smooth_scene(shape=(96, 120)):
    """Return a scene (H, W, 3), linear sRGB, of soft colors without edges, from 0.1 to 0.9."""
    y, x = np.mgrid[: shape[0], : shape[1]] / 60
    phases = np.array([0.0, 0.7, 1.4])
    return (0.5 + 0.2 * np.sin(2 * x[..., None] + phases) + 0.2 * np.cos(3 * y)[..., None]).astype(
        np.float32
    )


@pytest.mark.parametrize("pattern", PATTERNS.values(), ids=PATTERNS)
def test_a_smooth_scene_comes_back_through_the_camera_within_its_noise(pattern):
    E = smooth_scene()
    image = development.develop(photograph(E, pattern), pattern=pattern, **NUMBERS)
    truth = colour.encode_srgb(E)
    error = (image - truth)[2:-2, 2:-2]
    # In fractions of white, encoded. Photons alone make 0.4 % of noise or more: a pixel holds at most
    # 40 000 electrons, and the gain of red is 2.25.
    assert np.sqrt(np.mean(error**2)) < 0.006
    assert np.abs(error.mean(axis=(0, 1))).max() < 5e-4


def test_a_pixel_that_is_full_in_all_channels_is_white():
    E = np.full((12, 12, 3), 8.0, np.float32)
    image = development.develop(photograph(E, mosaic.BAYER), pattern=mosaic.BAYER, **NUMBERS)
    assert np.allclose(image, 1, atol=1e-3)


def test_the_last_step_is_the_developed_photo():
    Z = photograph(smooth_scene(), mosaic.BAYER)
    steps = list(development.develop_steps(Z, pattern=mosaic.BAYER, **NUMBERS))
    assert np.array_equal(steps[-1].image, development.develop(Z, pattern=mosaic.BAYER, **NUMBERS))
    assert [step.image.ndim for step in steps] == [2, 2, 3, 3, 3]


@pytest.mark.parametrize("place", ["chapel", "workshop", "street"])
def test_malvar_is_closer_to_what_the_filters_let_pass_than_bilinear_interpolation(place):
    E = getattr(scenes, place)((192, 288))
    camera = np.maximum(E @ CANON_OF_SRGB.T, 0)
    camera = np.clip(camera * (0.4 / np.quantile(camera, 0.9)), 0, 1)
    c = mosaic.tile(mosaic.BAYER, camera.shape[:2])
    X = mosaic.sample(camera, c)
    inside = slice(4, -4)
    psnr = []
    for demosaic in (mosaic.demosaic, malvar.demosaic):
        error = (demosaic(X, c) - camera)[inside, inside]
        psnr.append(-10 * np.log10(np.mean(error**2)))
    bilinear, gradient_corrected = psnr
    assert gradient_corrected > bilinear + 1


# Levels


def test_the_mean_of_a_dark_photo_is_no_light():
    Z = photograph(np.zeros((100, 100, 3), np.float32), mosaic.BAYER)
    X = development.normalize(Z, black=512, white=FULL_LEVEL)
    assert abs(X.mean()) * (FULL_LEVEL - 512) < 0.1  # levels
    assert X.min() < 0 < X.max()


def test_each_filter_can_have_its_own_black_level():
    black = mosaic.tile([[60, 64], [64, 70]], (4, 6))
    X = development.normalize(black + 400, black=black, white=4064)
    assert X == pytest.approx(400 / (4064 - black))


# The pattern


@pytest.mark.parametrize("place", ["chapel", "workshop", "street"])
@pytest.mark.parametrize("pattern", PATTERNS.values(), ids=PATTERNS)
def test_the_pattern_of_a_noisy_photo_in_neutral_light_is_found(place, pattern):
    Z = photograph(in_neutral_light(place), pattern, full=0.5)
    X = development.normalize(Z, black=512, white=FULL_LEVEL)
    assert development.find_pattern(X, GAINS).tolist() == pattern


@pytest.mark.parametrize("pattern", PATTERNS.values(), ids=PATTERNS)
def test_in_light_of_an_unknown_color_the_true_pattern_is_one_of_two_candidates(pattern):
    warm = scenes.chapel((192, 288)) * np.float32([1.5, 1.0, 0.4])
    Z = photograph(warm / np.quantile(warm, 0.99), pattern)
    X = development.normalize(Z, black=512, white=FULL_LEVEL)
    candidates = development.find_candidates(X)
    assert pattern in candidates.tolist()
    assert np.array_equal(candidates[0], np.array([2, 1, 0])[candidates[1]])  # red and blue swapped


def test_a_scene_and_its_blue_twin_cannot_be_distinguished():
    E = in_neutral_light("workshop")
    c = mosaic.tile([[0, 1], [1, 2]], E.shape[:2])
    twin = mosaic.tile([[2, 1], [1, 0]], E.shape[:2])
    assert np.array_equal(mosaic.sample(E, c), mosaic.sample(E[..., ::-1], twin))


# White balance


@pytest.mark.parametrize("method", ["gray_world", "white_patch", "gray_patch"])
def test_a_gray_wall_gives_the_gains_of_the_camera(method):
    wall = sensor.falloff((80, 80), 0.3)[..., None] * np.full(3, 0.6, np.float32)
    X = development.normalize(photograph(wall, mosaic.BAYER), black=512, white=FULL_LEVEL)
    c = mosaic.tile(mosaic.BAYER, X.shape)
    place = dict(rows=slice(20, 60), columns=slice(20, 60)) if method == "gray_patch" else {}
    assert getattr(development, method)(X, c, **place) == pytest.approx(GAINS, rel=0.02)


def test_a_gray_patch_is_right_where_gray_world_is_wrong():
    E = np.ones((60, 60, 3), np.float32) * np.float32([0.6, 0.2, 0.1])
    E[20:40, 20:40] = 0.4
    X = development.normalize(photograph(E, mosaic.BAYER), black=512, white=FULL_LEVEL)
    c = mosaic.tile(mosaic.BAYER, X.shape)
    patch = development.gray_patch(X, c, rows=slice(22, 38), columns=slice(22, 38))
    assert patch == pytest.approx(GAINS, rel=0.02)
    world = development.gray_world(X, c)
    assert world[2] / world[0] > 2 * GAINS[2] / GAINS[0]


def test_gains_count_by_their_ratios_and_keep_white_white():
    X = np.random.default_rng(0).random((8, 8))
    X[:2, :2] = 1
    c = mosaic.tile(mosaic.BAYER, X.shape)
    balanced = development.balance_white(X, c, [2, 1, 1.5])
    assert np.allclose(balanced, development.balance_white(X, c, [1, 0.5, 0.75]))
    assert np.all(balanced[:2, :2] == 1) and balanced.max() == 1


# The color matrix


def test_gray_stays_gray_and_colors_become_those_of_the_scene():
    E = np.random.default_rng(1).random((50, 3))
    balanced = (E @ CANON_OF_SRGB.T) / CANON_OF_SRGB.sum(axis=1)
    assert np.allclose(balanced @ CONVERSION.T, E)
    assert np.allclose(CONVERSION @ np.ones(3), 1)


def test_a_color_matrix_in_another_unit_gives_the_same_conversion():
    assert np.allclose(
        development.screen_from_camera(7 * CANON, development.XYZ_OF_SRGB), CONVERSION
    )


# LibRaw


def develop_by_libraw(path):
    """Return linear sRGB (H, W, 3) of a DNG, 0 to 65535, by LibRaw with bilinear interpolation."""
    rawpy = pytest.importorskip("rawpy", reason="RAW photographs need the extra `raw`")
    with rawpy.imread(str(path)) as file:
        return file.postprocess(
            demosaic_algorithm=rawpy.DemosaicAlgorithm.LINEAR,
            gamma=(1, 1),
            no_auto_bright=True,
            adjust_maximum_thr=0.0,
            output_bps=16,
            use_camera_wb=True,
            user_flip=0,
        )


def write_photo(path, E, pattern):
    numbers = dict(black=512, white=FULL_LEVEL, gains=GAINS, matrix=CANON)
    raw.write_dng(path, photograph(E, pattern), pattern=pattern, **numbers)
    return path


@pytest.mark.parametrize("pattern", PATTERNS.values(), ids=PATTERNS)
def test_each_pixel_equals_libraws_within_8_of_65535_steps(tmp_path, pattern):
    E = np.minimum(in_neutral_light("workshop") + np.float32(0.02), 3)  # no noise below black
    path = write_photo(tmp_path / "a.dng", E, pattern)
    theirs = develop_by_libraw(path)
    own = raw.read_mosaic(path)
    steps = development.develop_steps(
        own.levels,
        pattern=own.pattern,
        black=own.black,
        white=own.white,
        gains=own.gains,
        conversion=own.conversion,
        demosaic=mosaic.demosaic,
    )
    linear = {step.name: step.image for step in steps}["linear sRGB"]
    # LibRaw cuts off fractions after each step, and fills the outermost pixels in another way
    assert np.abs(65535 * linear - theirs)[2:-2, 2:-2].max() <= 8
    assert np.ptp(theirs) == 65535


def test_a_dng_is_read_as_it_was_written(tmp_path):
    pytest.importorskip("rawpy", reason="RAW photographs need the extra `raw`")
    E = in_neutral_light("street")
    own = raw.read_mosaic(write_photo(tmp_path / "a.dng", E, PATTERNS["GBRG"]))
    assert np.array_equal(own.levels, photograph(E, PATTERNS["GBRG"]))
    assert own.pattern.tolist() == PATTERNS["GBRG"]
    assert (own.black, own.white) == (512, FULL_LEVEL)
    assert own.gains == pytest.approx(GAINS / GAINS[1], rel=1e-5)


def test_libraw_computes_the_same_conversion_from_the_color_matrix(tmp_path):
    pytest.importorskip("rawpy", reason="RAW photographs need the extra `raw`")
    own = raw.read_mosaic(write_photo(tmp_path / "a.dng", smooth_scene(), mosaic.BAYER))
    # LibRaw's primaries of sRGB have more digits
    assert np.abs(own.conversion - CONVERSION).max() < 5e-4


# Invalid input


@pytest.mark.parametrize(
    "call",
    [
        lambda: development.normalize(np.ones((4, 4)), black=10, white=10),
        lambda: development.normalize(np.ones((4, 4, 3)), black=0, white=10),
        lambda: development.find_pattern(np.ones((8, 8)), GAINS),
        lambda: development.balance_white(np.ones((4, 4)), np.ones((4, 4), int), [1, 0, 1]),
        lambda: development.balance_white(np.ones((4, 4)), np.full((4, 4), 3), [1, 1, 1]),
        lambda: development.gray_world(np.ones((4, 4)), mosaic.tile(mosaic.BAYER, (4, 4))),
        lambda: development.white_patch(np.zeros((4, 4)), np.ones((4, 4), int), quantile=2),
        lambda: development.screen_from_camera(np.eye(4), development.XYZ_OF_SRGB),
        lambda: development.screen_from_camera(np.ones((3, 3)), development.XYZ_OF_SRGB),
        lambda: development.convert(np.ones((4, 4)), np.eye(3)),
    ],
)
def test_invalid_input_raises_an_error(call):
    with pytest.raises(InputError):
        call()


def test_default_demosaicing_is_malvars():
    Z = photograph(in_neutral_light("workshop"), mosaic.BAYER)
    both = [
        development.develop(Z, pattern=mosaic.BAYER, **NUMBERS, demosaic=demosaic)
        for demosaic in (malvar.demosaic, mosaic.demosaic)
    ]
    default = development.develop(Z, pattern=mosaic.BAYER, **NUMBERS)
    assert np.array_equal(default, both[0]) and not np.array_equal(default, both[1])
