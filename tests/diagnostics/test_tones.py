"""What one number for the whole image hides: a wrong tone, channel, photo or corner of the map."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from hdrlab import pipeline, scenes
from hdrlab.capture import camera
from hdrlab.core.bracket import bracket
from hdrlab.core.weights import gaussian
from hdrlab.diagnostics import consistency, tones
from hdrlab.errors import InputError
from hdrlab.fast.merge import merge_with_quality

SHAPE = (120, 180)
SENSOR = camera.Camera(response="srgb", full_well=20_000, read_noise=5)
LAST = 6


@pytest.fixture(scope="module")
def room():
    return scenes.room(SHAPE)


def shoot(E, *, changed_photo=None, gain=1.0, stops=1):
    """Return seven photos of E; the light of one of them is multiplied by `gain`."""
    times = camera.times_around(E, 7, stops=stops)
    images = []
    for j, time in enumerate(times):
        light = E * gain if j == changed_photo else E
        images.append(camera.shoot(light, [time], SENSOR, rng=j).images[0])
    return bracket(np.stack(images), times)


def add_black_floor(taken):
    """Return the photos as a scanner shows them, whose black is level 18 or 19."""
    floor = np.random.default_rng(1).integers(18, 20, taken.images.shape)
    return replace(taken, images=np.maximum(taken.images, floor).astype(np.uint8))


def assemble(taken, **options):
    return pipeline.assemble(taken, align="none", times="stated", **options)


def test_black_floors_that_outvote_the_longest_photo_in_the_dark_bring_a_warning(room):
    scanned = add_black_floor(shoot(room, stops=1.5))
    assembly = assemble(scanned, merge="log")
    assert assembly.spread < 0.25
    assert any("darkest parts" in warning for warning in assembly.warnings)


def test_the_default_merge_of_a_scan_with_a_black_floor_agrees_with_its_longest_photo(room):
    assert assemble(add_black_floor(shoot(room, stops=1.5))).warnings == ()


@pytest.mark.parametrize("photo", [3, LAST])
def test_a_channel_that_is_wrong_in_one_photo_brings_a_warning(room, photo):
    assembly = assemble(shoot(room, changed_photo=photo, gain=np.array([1, 1, 0.6])))
    assert assembly.spread < 0.1
    assert assembly.warnings


def test_light_that_changed_in_a_quarter_of_the_longest_photo_brings_a_warning(room):
    gain = np.ones((*SHAPE, 1))
    gain[:60, :90] = 0.6
    assembly = assemble(shoot(room, changed_photo=LAST, gain=gain), ghosts="none")
    assert assembly.spread < 0.1
    assert assembly.warnings


@pytest.mark.parametrize("response", ["srgb", "film", "gamma"])
@pytest.mark.parametrize("count", [3, 5])
def test_a_sound_bracket_with_noise_brings_no_warning(room, response, count):
    noisy = camera.Camera(response=response, full_well=3000, read_noise=8)
    taken = camera.shoot(room, camera.times_around(room, count), noisy, rng=2)
    assert assemble(taken).warnings == ()


def measure_parts(images, times, E, *, dtype=np.uint8, moving=None, valid=None):
    g = np.log((np.arange(2 ** (8 * np.dtype(dtype).itemsize)) + 0.5) / 100)
    blocks = tones.measure_block_errors(np.asarray(images, dtype), times, g, E, valid=valid)
    return tones.measure_part_errors(blocks, moving=moving)


def test_the_error_of_a_tone_is_that_of_the_map_in_stops():
    ramp = np.tile(np.linspace(20, 120, 160), (160, 1))
    images = np.round([ramp, 2 * ramp])
    E = (ramp + 0.25) / 100
    E[ramp < 26] *= 4
    parts = measure_parts(images, [1, 2], E)
    dark = [part.stops for part in parts if part.kind == "dark"]
    image = [part.stops for part in parts if part.kind == "image"]
    assert max(dark) == pytest.approx(2, abs=0.05)
    assert max(image) == pytest.approx(0, abs=0.05)


def test_16_bit_photos_are_compared_like_8_bit_photos():
    ramp = np.tile(np.linspace(20, 120, 80), (80, 1))
    images = np.round(257 * np.array([ramp, 2 * ramp]))
    E = 257 * ramp / 100
    E[:20, :20] *= 2
    parts = measure_parts(images, [1, 2], E, dtype=np.uint16)
    first_tile = [part for part in parts if part.kind == "tile" and part.index == 0]
    assert first_tile[0].stops == pytest.approx(1, abs=0.02)


def test_what_moved_is_not_compared():
    images = np.full((2, 80, 80), 100)
    images[1] = 200
    E = np.ones((80, 80))
    moving = np.zeros(E.shape, int)
    E[:20, :20] = 8
    moving[:20, :20] = 1
    assert max(part.stops for part in measure_parts(images, [1, 2], E)) > 2
    parts = measure_parts(images, [1, 2], E, moving=moving)
    assert max(abs(part.stops) for part in parts) < 0.02


def test_masked_and_clipped_pixels_of_a_photo_do_not_count():
    images = np.full((2, 80, 80), 100)
    images[1] = 255
    images[1, :40] = 30
    valid = np.ones(images.shape, bool)
    valid[1, :40] = False
    parts = measure_parts(images, [1, 2], np.full((80, 80), 1.005), valid=valid)
    assert max(abs(part.stops) for part in parts) < 0.02


def test_overshoot_of_sharpening_next_to_clipped_pixels_is_not_an_error():
    """It takes more from the neighbors of a bright pane in a photo that does not clip the pane."""
    X = np.full((120, 160), 20.0)
    for column in range(4, 160, 12):
        X[:, column : column + 3] = 4000
    X[80:] = 20
    images = []
    for time in (0.05, 2.5):
        soft = np.minimum(time * X, 255)
        images.append(np.clip(soft + 0.5 * (soft - gaussian_filter(soft, 1)), 0, 255))
    parts = measure_parts(np.round(images), [0.05, 2.5], X / 100)
    assert parts
    assert max(abs(part.stops) for part in parts) < 0.1


@pytest.mark.parametrize("shape", [(3, 5), (1, 1), (80, 80)])
def test_images_that_are_too_small_or_black_have_no_parts(shape):
    images = np.full((2, *shape), 2)
    assert measure_parts(images, [1, 2], np.ones(shape)) == ()


def test_a_map_of_another_shape_raises_an_error():
    with pytest.raises(InputError, match="shape"):
        measure_parts(np.full((2, 8, 8), 100), [1, 2], np.ones((8, 9)))


def test_the_spread_of_a_scan_hides_what_its_darkest_twentieth_shows(room):
    """This is why the parts exist: the spread is small although the dark is a stop too bright."""
    scanned = add_black_floor(shoot(room, stops=1.5))
    g = assemble(scanned).g
    E = merge_with_quality(scanned.images, scanned.times, g, gaussian(256), method="log").E
    medians = consistency.measure_level_exposures(scanned.images, scanned.times, E)
    blocks = tones.measure_block_errors(scanned.images, scanned.times, g, E)
    dark = [part.stops for part in tones.measure_part_errors(blocks) if part.kind == "dark"]
    assert consistency.measure_spread(medians) < 0.25
    assert max(dark) > 1


@pytest.mark.parametrize("merge", ["log", "mean", "likelihood", "shot"])
def test_a_warning_about_dark_parts_recommends_another_merge_only_where_that_helps(merge):
    dark = tones.PartError(kind="dark", index=0, channel=0, stops=1.5, is_between_photos=False)
    text = tones.warn_of_dark_parts([dark], merge=merge)
    assert ("--merge shot" in text) == (merge in ("log", "mean"))


def test_a_warning_about_a_part_names_the_maps_to_compare_with_if_there_are_any():
    tile = tones.PartError(kind="tile", index=3, channel=1, stops=0.7, is_between_photos=False)
    assert "--ghosts none" in tones.warn_of_parts([tile], "ab", alternatives=["--ghosts none"])
    assert "compare" not in tones.warn_of_parts([tile], "ab")


@pytest.mark.parametrize(("of_map", "follows"), [(0.1, True), (0.3, False), (0.49, False)])
def test_the_map_is_said_to_follow_a_photo_only_where_it_clearly_does(of_map, follows):
    """From 0.5 on, the warning says that the map contradicts this photo."""
    parts = [
        tones.PartError(kind="image", index=0, channel=0, stops=of_map),
        tones.PartError(kind="image", index=0, channel=0, stops=0.7, is_between_photos=True),
    ]
    text = tones.warn_of_parts(parts, ["a", "b"])
    assert "two photos contradict each other by 0.70 stops" in text
    assert ("the map follows" in text) == follows
