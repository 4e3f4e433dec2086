"""`hdrlab plan`, `hdrlab meter` and `hdrlab correct`: their decisions and explanations."""

import re

import numpy as np
import pytest
import tifffile
from click.testing import CliRunner
from skimage import data

from hdrlab.cli import capture
from hdrlab.core.colour import to_8bit
from hdrlab.errors import InputError
from hdrlab.io import photos, radiance


def run(command, *arguments):
    result = CliRunner().invoke(command, [str(argument) for argument in arguments])
    if result.exception and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result.output


def test_plan_states_the_number_of_photos_and_their_times():
    output = run(capture.plan, 0.01, 30000)
    assert "21.5 stops" in output and "5 photos, 4 stops apart, f/8, ISO 100" in output
    assert [line.split()[0] for line in output.splitlines()[2:]] == [
        "1/500",
        "1/30",
        "1/2",
        "8",
        "128",
    ]


def test_plan_takes_the_range_of_a_radiance_map(tmp_path):
    radiance.write_radiance(
        tmp_path / "a.pfm", np.geomspace(0.01, 30000, 5000, dtype=np.float32).reshape(50, 100)
    )
    output = run(capture.plan, "--map", tmp_path / "a.pfm")
    assert "21.5 stops" in output and "5 photos" in output


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        ((), "LOW and HIGH"),
        (("1",), "LOW and HIGH"),
        (("--low", "0"), "LOW and HIGH"),
        (("2", "1"), "low <= high"),
        (("1", "2", "--overlap", "7"), "overlap"),
        (("1", "2", "--map", "a.pfm"), "--map"),
        (("--high", "2", "--map", "a.pfm"), "--map"),
        (("1", "2", "--low", "1"), "--low"),
        (("1", "2", "--high", "2"), "--high"),
        (("1", "2", "--camera", "model.toml"), "--camera"),
    ],
)
def test_plan_rejects_bad_ranges_and_unused_options(arguments, named):
    with pytest.raises(InputError, match=named):
        run(capture.plan, *arguments)


@pytest.mark.parametrize(
    ("option", "line"), [("--aperture", "aperture = 4"), ("--iso", "speeds = [100, 800]")]
)
def test_plan_rejects_an_option_that_the_camera_file_also_sets(option, line, tmp_path):
    (tmp_path / "model.toml").write_text(line)
    scene = (0.5, 500, "--snr", 8, "--camera", tmp_path / "model.toml")
    run(capture.plan, *scene)
    with pytest.raises(InputError, match=option):
        run(capture.plan, *scene, option, 5.6)


def test_plan_by_noise_is_listed_after_the_plan_by_stops_and_is_faster(tmp_path):
    (tmp_path / "model.toml").write_text("read_noise = 3\nspeeds = [100, 800]\nconverter_noise = 3")
    scene = ("--low", 0.5, "--high", 500, "--snr", 8)
    output = run(capture.plan, *scene, "--camera", tmp_path / "model.toml")
    stops = re.search(r"by stops: .* in ([\d.]+) s .* ([\d.]+)$", output, re.M)
    noise = re.search(r"by noise: .* in ([\d.]+) s .* ([\d.]+)$", output, re.M)
    assert float(noise[1]) < float(stops[1]) and float(noise[2]) >= 8
    assert "at ISO 800" in output and "2 photos, 4 stops apart" in output
    assert "at ISO 800" not in run(capture.plan, *scene)
    assert "noise" not in run(capture.plan, 0.5, 500)


@pytest.mark.parametrize(
    "text",
    ["speeds = []", "speeds = 100", "read_noise = 'low'", "noise = 3", "gain = ", "gain = 0"],
)
def test_plan_rejects_invalid_camera_files(tmp_path, text):
    (tmp_path / "model.toml").write_text(text)
    with pytest.raises(InputError):
        run(capture.plan, 0.5, 500, "--snr", 20, "--camera", tmp_path / "model.toml")


@pytest.mark.parametrize("mode", capture.METERING_MODES)
def test_meter_reports_reading_and_stops_in_every_mode(tmp_path, mode):
    photos.write_picture(tmp_path / "gray.png", to_8bit(np.full((40, 60, 3), 0.09, np.float32)))
    output = run(capture.meter, tmp_path / "gray.png", "--mode", mode)
    assert "reading 0.09" in output and "1.0 stops too dark" in output


def test_meter_offers_every_mode_of_the_library():
    from hdrlab.capture import metering

    assert capture.METERING_MODES == metering.MODES


def test_meter_reads_the_spot_at_the_given_place(tmp_path):
    E = np.full((40, 60), 0.09, np.float32)
    E[:, 30:] = 0.72
    photos.write_picture(tmp_path / "two.png", to_8bit(E))
    left = run(capture.meter, tmp_path / "two.png", "--mode", "spot", "--at", "0.5,0.2")
    right = run(capture.meter, tmp_path / "two.png", "--mode", "spot", "--at", "0.5,0.8")
    assert "1.0 stops too dark" in left and "2.0 stops too bright" in right


def test_meter_states_the_fraction_of_clipped_pixels(tmp_path):
    photos.write_picture(tmp_path / "white.png", np.full((40, 60, 3), 255, np.uint8))
    assert "100% of their weight is on clipped pixels" in run(capture.meter, tmp_path / "white.png")


@pytest.mark.papers
def test_meter_states_the_right_exposure_time(shared):
    photo = sorted(shared("window").glob("*.jpg"))[5]
    assert "taken with 1/30 s; the right time is 1/40 s" in run(capture.meter, photo)


def test_meter_rejects_invalid_places(tmp_path):
    with pytest.raises(ValueError, match="--at"):
        run(capture.meter, tmp_path / "a.png", "--at", "middle")


def test_correct_reports_its_region_and_correction(tmp_path):
    photos.write_picture(tmp_path / "dark.png", data.astronaut() // 3)
    output = run(capture.correct, tmp_path / "dark.png", "-o", tmp_path / "light.png")
    assert "important region: skin" in output and "stops: mean pixel value 12" in output
    assert (
        photos.read_photo(tmp_path / "light.png").mean()
        > 2 * photos.read_photo(tmp_path / "dark.png").mean()
    )


def test_correct_does_not_change_a_well_exposed_photo(tmp_path):
    photos.write_picture(tmp_path / "good.png", data.astronaut())
    assert "unchanged" in run(capture.correct, tmp_path / "good.png", "-o", tmp_path / "same.png")
    assert np.array_equal(photos.read_photo(tmp_path / "same.png"), data.astronaut())


def test_correct_accepts_16_bit_photos(tmp_path):
    tifffile.imwrite(tmp_path / "dark.tif", data.astronaut()[:128, :256].astype(np.uint16) * 64)
    run(capture.correct, tmp_path / "dark.tif", "-o", tmp_path / "light.png", "--by", "blocks")
    assert photos.read_photo(tmp_path / "light.png").dtype == np.uint8


def test_correct_by_skin_rejects_gray_photos(tmp_path):
    photos.write_picture(tmp_path / "gray.png", data.brick())
    with pytest.raises(ValueError, match="skin"):
        run(capture.correct, tmp_path / "gray.png", "-o", tmp_path / "out.png", "--by", "skin")
    assert not (tmp_path / "out.png").exists()
