"""`hdrlab noise`, and the commands that read its file."""

import json

import numpy as np
import pytest
from test_cli import hdrlab

from benchmarks import own_camera
from hdrlab.capture.sensor import Sensor
from hdrlab.io.photos import write_picture

pytest.importorskip("rawpy", reason="RAW photographs need the extra `raw`")
pytest.importorskip("tifffile")

STUDIO = own_camera.Studio(side=200, times=(0.02, 0.1, 0.3, 0.45, 0.6, 0.85, 1.4, 2.6))
CAMERA = Sensor(full_well=20_000, read_noise=6, gain=5.5, bits=12, black=128)


@pytest.fixture(scope="module")
def home(tmp_path_factory):
    """A folder with dark frames, flat fields, and the file of their noise."""
    home = tmp_path_factory.mktemp("own")
    dark, flat = own_camera.write_photos(home, CAMERA, studio=STUDIO)
    assert hdrlab("noise", dark, flat, "-o", home / "noise.json") == 0
    return home


def test_noise_prints_a_table_with_units_and_writes_json(home, capsys):
    code, output, errors = hdrlab("noise", home / "dark", home / "flat", capsys=capsys)
    assert code == 0 and errors == ""
    lines = output.splitlines()
    assert lines[0] == "Simulated, ISO 100, with 95 % intervals:"
    assert lines[2].split("  ")[0] == "" and "(electrons per level)" in lines[2]
    assert [line.split()[0] for line in lines[3:]] == ["red", "green", "blue"]
    content = json.loads((home / "noise.json").read_text())
    assert content["version"] == 1 and content["units"]["gain"] == "electrons per level"
    gain = content["channels"][1]["gain"]
    assert gain["low"] < 5.5 < gain["high"]


def test_noise_prints_warnings_and_still_writes_its_file(home, tmp_path, capsys):
    fault = own_camera.make_faults(CAMERA)["clipping at 80 % of the white level"]
    folders = own_camera.write_photos(tmp_path, CAMERA, studio=STUDIO, fault=fault)
    code, _, errors = hdrlab("noise", *folders, "-o", tmp_path / "noise.json", capsys=capsys)
    assert code == 0 and errors.startswith("warning: pixels are full at level")
    assert json.loads((tmp_path / "noise.json").read_text())["warnings"]


def test_a_failed_measurement_leaves_the_old_file(home, tmp_path, capsys):
    (tmp_path / "noise.json").write_text("old")
    code, _, errors = hdrlab(
        "noise", home / "flat", home / "dark", "-o", tmp_path / "noise.json", capsys=capsys
    )
    assert code == 2 and errors.count("\n") == 1
    assert (tmp_path / "noise.json").read_text() == "old"


def test_assemble_uses_the_measured_noise(home, tmp_path, capsys):
    arguments = ["-o", tmp_path / "a.exr", "--uncertainty", tmp_path / "s.exr", "--align", "none"]
    flats = [home / "flat" / f"IMG_{number}.dng" for number in (4, 8, 12)]
    measured = hdrlab("assemble", *flats, *arguments, "--noise", home / "noise.json", capsys=capsys)
    estimated = hdrlab("assemble", *flats, *arguments, capsys=capsys)
    assert measured[0] == estimated[0] == 0
    assert "of the pixels are known to" in measured[1]
    assert measured[1] != estimated[1]


def test_assemble_refuses_noise_that_is_not_that_of_the_photos(home, tmp_path, capsys):
    for name, level in (("a.jpg", 50), ("b.jpg", 100)):
        write_picture(tmp_path / name, np.full((20, 20, 3), level, np.uint8))
    words = ["assemble", tmp_path, "--stops", "1", "-o", tmp_path / "a.exr"]
    noise = ["--noise", home / "noise.json"]
    code, _, errors = hdrlab(*words, *noise, capsys=capsys)
    assert code == 2 and "only with --uncertainty" in errors
    code, _, errors = hdrlab(*words, *noise, "--uncertainty", tmp_path / "s.exr", capsys=capsys)
    assert code == 2 and "noise.json: a.jpg" in errors and "RAW" in errors
    assert not (tmp_path / "a.exr").exists()


def test_plan_reads_the_measured_noise(home, capsys):
    words = ["plan", "0.5", "10000", "--snr", "20"]
    code, output, _ = hdrlab(*words, "--camera", home / "noise.json", capsys=capsys)
    assert code == 0 and "by noise: " in output and "at ISO 100" in output
