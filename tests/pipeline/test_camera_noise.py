"""Camera noise measured from dark frames and flat fields: values, intervals and detected faults.

The cameras are simulated, and their photos are DNG files, so that the truth is known.
"""

import dataclasses
import math
import shutil

import numpy as np
import pytest

from benchmarks import own_camera
from benchmarks.own_camera import Studio
from hdrlab import pipeline
from hdrlab.capture import sensor
from hdrlab.capture.development import XYZ_OF_SRGB
from hdrlab.capture.sensor import Sensor
from hdrlab.diagnostics import camera_noise as kinds
from hdrlab.errors import CalibrationError, FileFormatError, InputError
from hdrlab.io import raw
from hdrlab.io.decode import read_header
from hdrlab.io.exif_exposure import Exposure
from hdrlab.io.photos import read_bracket, write_picture
from hdrlab.pipeline import camera_noise

tifffile = pytest.importorskip("tifffile")
pytest.importorskip("rawpy", reason="RAW photographs need the extra `raw`")

CAMERA = Sensor(full_well=20_000, read_noise=6, gain=5.5, bits=12, black=128)
# enough for all checks, with fewer pairs than the benchmark has
TIMES = (0.001, 0.004, 0.02, 0.1, 0.3, 0.45, 0.6, 0.85, 1.4, 2.6)
SMALL = Studio(side=240, times=TIMES)
LARGE = Studio(side=360, times=TIMES)
FOUR_PAIRS = Studio(side=120, times=(0.1, 0.3, 0.6, 0.9))


def measure(folder, simulated=CAMERA, **settings):
    settings = {"studio": SMALL} | settings
    return pipeline.measure_camera_noise(*own_camera.write_photos(folder, simulated, **settings))


def kinds_of(noise):
    return {warning.kind for warning in noise.warnings}


def value(noise, quantity):
    """Return a quantity of all channels."""
    return np.array([getattr(channel, quantity).value for channel in noise.channels])


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    return own_camera.write_photos(tmp_path_factory.mktemp("own"), CAMERA, studio=SMALL)


@pytest.fixture(scope="module")
def measured(folders):
    return pipeline.measure_camera_noise(*folders)


# Figures


@pytest.mark.parametrize("number", [0, 3, 17])
def test_gain_and_full_well_of_a_camera_are_right_within_5_percent(number, tmp_path):
    simulated = own_camera.make_sensor(number)
    noise = measure(tmp_path, simulated, rng=number)
    errors = own_camera.compare(noise, simulated)
    assert noise.warnings == ()
    assert max(errors.gain, errors.full_well, errors.read_noise) < 0.05
    assert [channel.name for channel in noise.channels] == ["red", "green", "blue"]


@pytest.mark.papers
def test_of_20_cameras_every_figure_is_right_and_95_percent_of_the_intervals_hold_it(tmp_path):
    held = []
    for number in range(own_camera.CAMERAS):
        simulated = own_camera.make_sensor(number)
        noise = measure(tmp_path / str(number), simulated, studio=Studio(), rng=number)
        errors = own_camera.compare(noise, simulated)
        assert noise.warnings == (), number
        assert max(errors.gain, errors.full_well, errors.read_noise) < 0.05, number
        for quantity in ("gain", "read_noise", "black"):
            held += errors.holds[quantity]
        shutil.rmtree(tmp_path / str(number))
    # 180 intervals: 95 %, less three standard deviations
    assert np.mean(held) > 0.95 - 3 * np.sqrt(0.95 * 0.05 / len(held))


def test_intervals_hold_the_truth_as_often_as_they_say(measured):
    """Each quantity has 3 channels: one miss in 12 happens by chance, four do not."""
    errors = own_camera.compare(measured, CAMERA)
    assert sum(not held for holds in errors.holds.values() for held in holds) < 4


def test_vignetting_changes_no_figure(tmp_path, measured):
    uneven = measure(tmp_path, studio=dataclasses.replace(SMALL, vignetting=0.8))
    assert uneven.warnings == ()
    assert value(uneven, "gain") == pytest.approx(value(measured, "gain"), rel=0.04)


def test_light_may_change_instead_of_the_time(tmp_path):
    dark, flat = own_camera.write_photos(tmp_path, CAMERA, studio=SMALL)
    for path in flat.iterdir():
        levels = raw.read_mosaic(path).levels
        write_dng(path, levels, exposure=Exposure(0.1, 8, 100))
    noise = pipeline.measure_camera_noise(dark, flat)
    assert noise.warnings == ()
    assert value(noise, "gain") == pytest.approx(CAMERA.gain, rel=0.05)


def test_hot_pixels_change_no_figure(tmp_path):
    hot = np.random.default_rng(0).random((240, 240)) < 0.002

    def heat(Z, time, which):
        return np.where(hot, 3000 + 900 * which, Z).astype(np.uint16)

    noise = measure(tmp_path, fault=heat)
    assert noise.warnings == ()
    assert own_camera.compare(noise, CAMERA).read_noise < 0.05
    assert own_camera.compare(noise, CAMERA).gain < 0.05


def test_read_noise_that_rounding_hides_gets_an_upper_limit(tmp_path):
    quiet = CAMERA._replace(read_noise=0.3 * CAMERA.gain)
    noise = measure(tmp_path, quiet)
    assert np.isnan(value(noise, "read_noise")).all()
    for channel in noise.channels:
        assert channel.read_noise.low < quiet.read_noise < channel.read_noise.high
    assert "below" in str(noise) and "hides the read noise" in noise.notes[0]


def test_a_well_that_no_flat_fills_gets_a_lower_limit(tmp_path):
    noise = measure(tmp_path, studio=Studio(side=240, times=(0.05, 0.1, 0.2, 0.3, 0.5)))
    for channel in noise.channels:
        assert channel.full_well.low < CAMERA.full_well < channel.full_well.high == math.inf
    assert "at least" in str(noise) and "no flat is full" in noise.notes[0]


def test_linear_files_whose_levels_are_multiples_of_16_have_the_gain_of_these_levels(tmp_path):
    wall = np.ones((200, 300), np.float32)
    rng = np.random.default_rng(0)
    for folder, times in (("dark", [0]), ("flat", [0.05, 0.2, 0.4, 0.6, 0.8, 1.5])):
        (tmp_path / folder).mkdir()
        for number, time in enumerate(np.repeat(times, 2)):
            Z = 16 * sensor.raw(wall, float(time), CAMERA, rng=rng)
            tifffile.imwrite(tmp_path / folder / f"{number}.tif", Z.astype(np.uint16))
    noise = pipeline.measure_camera_noise(tmp_path / "dark", tmp_path / "flat")
    (gray,) = noise.channels
    assert gray.gain.value == pytest.approx(CAMERA.gain / 16, rel=0.03)
    assert gray.read_noise.value == pytest.approx(CAMERA.read_noise, rel=0.03)
    assert gray.black.value == pytest.approx(16 * CAMERA.black, abs=1)
    assert noise.kind == "linear" and "no ISO speed" in " ".join(noise.notes)


# Faults


FAULTS = own_camera.FAULT_KINDS
# faults that have other effects than their own
SIDE_EFFECTS = {
    "tone curve x - 0.05 x^2": {kinds.EARLY_CLIPPING},
    "all photos denoised": {kinds.DENOISED_DARKS},
}


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_of_the_photos_is_named(name, tmp_path):
    fault = own_camera.make_faults(CAMERA)[name]
    kinds = kinds_of(measure(tmp_path, fault=fault, studio=LARGE))
    assert FAULTS[name] in kinds
    assert kinds <= {FAULTS[name]} | SIDE_EFFECTS.get(name, set())


def test_each_fault_that_can_be_simulated_is_tested():
    assert set(own_camera.make_faults(CAMERA)) == set(FAULTS)


@pytest.mark.parametrize(
    "name", [name for name in FAULTS if "light changes" in name or "lamp" in name]
)
def test_a_pair_with_unsteady_light_is_left_out_and_the_gain_is_right(name, tmp_path):
    noise = measure(tmp_path, fault=own_camera.make_faults(CAMERA)[name])
    assert value(noise, "gain") == pytest.approx(CAMERA.gain, rel=0.05)
    assert "IMG_" in noise.warnings[0].text


def test_only_unsteady_light_is_an_error(tmp_path):
    def flicker(Z, time, which):
        return np.rint(128 + (Z - 128.0) * (1 - 0.1 * which)).astype(np.uint16) if time else Z

    with pytest.raises(CalibrationError, match=r"at least 3 pairs.*IMG_2.dng and IMG_3.dng"):
        measure(tmp_path, fault=flicker)


# Folders


def write_dng(path, levels, *, exposure, camera="Simulated"):
    raw.write_dng(
        path,
        levels,
        pattern=own_camera.PATTERN,
        black=CAMERA.black,
        white=own_camera.white_level(CAMERA),
        gains=own_camera.GAINS,
        matrix=own_camera.MATRIX,
        exposure=exposure,
        camera=camera,
    )


@pytest.fixture
def own(tmp_path):
    return own_camera.write_photos(tmp_path, CAMERA, studio=FOUR_PAIRS)


def test_a_dng_states_the_exposure_and_the_camera_that_it_was_written_with(tmp_path):
    levels = np.full((64, 64), 1000, np.uint16)
    write_dng(tmp_path / "a.dng", levels, exposure=Exposure(0.004, 5.6, 400), camera="Model 1")
    header = read_header(tmp_path / "a.dng")
    assert header.exposure == pytest.approx((0.004, 5.6, 400))
    assert header.camera == "Model 1"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (dict(iso=200), "one ISO speed.* has 100, .* has 200"),
        (dict(camera="Another"), "one camera.* has Simulated, .* has Another"),
        (dict(side=180), "one size.* 120 x 120 pixels, .* 180 x 180"),
    ],
)
def test_photos_of_another_speed_camera_or_size_are_named(change, message, own, tmp_path):
    other = dataclasses.replace(FOUR_PAIRS, **change)
    _, flat = own_camera.write_photos(tmp_path / "other", CAMERA, studio=other)
    shutil.copy(flat / "IMG_2.dng", own[1] / "Z.dng")
    with pytest.raises(InputError, match=message):
        pipeline.measure_camera_noise(*own)


def test_a_photo_without_a_partner_is_skipped_with_a_note(own):
    (own[1] / "IMG_9.dng").unlink()
    notes = pipeline.measure_camera_noise(*own).notes
    assert any("IMG_8.dng: skipped" in note for note in notes)


def test_the_jpeg_beside_each_raw_photo_is_skipped_with_a_note(own):
    for folder in own:
        for path in list(folder.iterdir()):
            write_picture(path.with_suffix(".jpg"), np.zeros((9, 9, 3), np.uint8))
    notes = pipeline.measure_camera_noise(*own).notes
    assert sum("other formats" in note for note in notes) == 2


def test_a_jpeg_is_refused_with_what_cannot_be_known_of_it(own, tmp_path):
    write_picture(tmp_path / "dark" / "a.jpg", np.zeros((9, 9, 3), np.uint8))
    with pytest.raises(InputError, match=r"a.jpg: .*JPEG.*neither .* gain|a.jpg: .*electrons"):
        pipeline.measure_camera_noise(*own)


def test_photos_of_8_bits_are_refused(tmp_path):
    for number in range(4):
        write_picture(tmp_path / f"{number}.png", np.zeros((9, 9, 3), np.uint8))
    with pytest.raises(InputError, match=r"0.png: .*8 bits"):
        pipeline.measure_camera_noise(tmp_path, tmp_path)


def test_swapped_folders_are_recognized(own):
    dark, flat = own
    for number, path in enumerate(sorted(dark.iterdir()) * 4):
        if number > 1:
            shutil.copy(path, dark / f"copy{number}.dng")
    with pytest.raises(CalibrationError, match="darks first, then that of flats"):
        pipeline.measure_camera_noise(flat, dark)


def test_too_few_photos_are_an_error_that_says_what_to_take(own):
    dark, flat = own
    for path in sorted(flat.iterdir())[4:]:
        path.unlink()
    with pytest.raises(InputError, match="at least 3 pairs of flats, got 2; take two photos"):
        pipeline.measure_camera_noise(dark, flat)
    (dark / "IMG_1.dng").unlink()
    with pytest.raises(InputError, match="at least two photos, got IMG_0.dng alone"):
        pipeline.measure_camera_noise(dark, flat)


# The file


def test_a_file_holds_all_that_was_measured(tmp_path, measured):
    path = pipeline.write_camera_noise(tmp_path / "noise.json", measured)
    copy = pipeline.read_camera_noise(path)
    assert str(copy) == str(measured)
    assert (copy.camera, copy.iso, copy.kind) == ("Simulated", 100, "RAW")
    for mine, theirs in zip(copy.channels, measured.channels, strict=True):
        assert np.array_equal(mine.S, theirs.S) and np.array_equal(mine.V, theirs.V)


def test_limits_survive_a_file(tmp_path):
    quiet = CAMERA._replace(read_noise=1.0)
    noise = measure(tmp_path, quiet, studio=Studio(side=240, times=(0.05, 0.1, 0.2, 0.3, 0.5)))
    copy = pipeline.read_camera_noise(pipeline.write_camera_noise(tmp_path / "a.json", noise))
    for channel in copy.channels:
        assert math.isnan(channel.read_noise.value) and math.isinf(channel.full_well.high)
    assert copy.notes == noise.notes


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[1]",
        "{}",
        "null",
        '{"format": "another"}',
        '{"format": "hdrlab camera noise", "version": 2}',
        '{"format": "hdrlab camera noise", "version": 1}',
    ],
)
def test_another_file_is_an_error_that_names_it(text, tmp_path):
    (tmp_path / "a.json").write_text(text)
    with pytest.raises(FileFormatError, match=r"a\.json"):
        pipeline.read_camera_noise(tmp_path / "a.json")


# The merge


@pytest.fixture(scope="module")
def bracket_folder(tmp_path_factory):
    """Three RAW photos of a smooth gray scene, and its radiance."""
    folder = tmp_path_factory.mktemp("bracket")
    light = np.repeat(np.geomspace(0.01, 3, 300)[None, :], 240, axis=0)
    matrix = np.array(own_camera.MATRIX) @ XYZ_OF_SRGB
    filters = (matrix.sum(axis=1) / matrix.sum(axis=1).max()).astype(np.float32)
    rng = np.random.default_rng(2)
    for number, time in enumerate((0.1, 0.4, 1.6)):
        E = (light[..., None] * filters).astype(np.float32)
        levels = sensor.raw(E, time, CAMERA, bayer=True, rng=rng)
        raw.write_dng(
            folder / f"{number}.dng",
            levels,
            pattern=own_camera.PATTERN,
            black=CAMERA.black,
            white=own_camera.white_level(CAMERA),
            gains=1 / filters,
            matrix=own_camera.MATRIX,
            exposure=Exposure(time / 100, 8, 100),
            camera="Simulated",
        )
    return folder, light


def test_the_measured_noise_gives_the_deviation_of_a_developed_pixel(bracket_folder, measured):
    """Demosaicing averages pixels of the smooth scene, so the errors are 0.65 to 1 times s."""
    folder, light = bracket_folder
    assembly = pipeline.assemble(read_bracket(folder), align="none")
    noise = camera_noise.noise_of_developed(measured, folder / "0.dng")
    merged = pipeline.measure_deviation(assembly, noise)
    for c in range(3):
        is_measured = np.isfinite(merged.s[..., c])
        E = merged.E[..., c][is_measured]
        truth = light[is_measured] * np.median(E / light[is_measured])
        z = (E - truth) / merged.s[..., c][is_measured]
        assert 0.55 < np.sqrt(np.mean(z**2)) < 1.05
        assert np.mean(np.abs(z) < 1.96) > 0.94


def test_photos_of_another_camera_or_speed_are_refused(bracket_folder, measured):
    headers = [read_header(path) for path in sorted(bracket_folder[0].iterdir())]
    camera_noise.require_same_camera(measured, headers)
    faster = dataclasses.replace(measured, iso=400)
    with pytest.raises(InputError, match="0.dng: taken at ISO 100, .* measured at ISO 400"):
        camera_noise.require_same_camera(faster, headers)
    other = dataclasses.replace(measured, camera="Another")
    with pytest.raises(InputError, match="0.dng: taken with Simulated, .* that of Another"):
        camera_noise.require_same_camera(other, headers)
    without_blue = dataclasses.replace(measured, channels=measured.channels[:2])
    with pytest.raises(InputError, match="noise of red, green, blue, got that of red, green"):
        camera_noise.require_same_camera(without_blue, headers)


def test_noise_measured_through_a_tone_curve_is_refused(bracket_folder, tmp_path):
    curve = own_camera.make_faults(CAMERA)["tone curve x^0.9"]
    noise = measure(tmp_path, fault=curve, studio=LARGE)
    headers = [read_header(path) for path in sorted(bracket_folder[0].iterdir())]
    with pytest.raises(InputError, match="of no use: a tone curve"):
        camera_noise.require_same_camera(noise, headers)
