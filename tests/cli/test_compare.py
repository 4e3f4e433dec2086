"""`hdrlab compare`, and the progress messages of slow commands."""

import io
import re
import time

import numpy as np
import pytest
from PIL import Image
from test_cli import hdrlab

from hdrlab import scenes
from hdrlab.cli.terminal import elapsed
from hdrlab.io import radiance
from hdrlab.pipeline import catalogue


@pytest.fixture
def map_file(tmp_path):
    file = tmp_path / "scene.exr"
    radiance.write_radiance(file, scenes.room((48, 64)))
    return file


def alt_of(sheet):
    with Image.open(sheet) as file:
        return file.text["Description"]


def test_compare_makes_a_sheet_of_every_operator(map_file, tmp_path, capsys):
    sheet = tmp_path / "sheet.png"
    code, output, complaint = hdrlab("compare", map_file, "-o", sheet, capsys=capsys)
    assert code == 0 and str(sheet) in output and complaint == ""
    alt = alt_of(sheet)
    assert "scene.exr, 64 x 48" in alt and "decades" in alt
    operators = ["photograph", *catalogue.names("tonemap")]
    assert f"{len(operators)} tone-mapping operators" in alt
    assert all(f"{name}: Q 0." in alt for name in operators)


def test_compare_uses_the_named_operators(map_file, tmp_path):
    sheet = tmp_path / "sheet.png"
    assert hdrlab("compare", map_file, "-o", sheet, "--operators", "reinhard, curves") == 0
    assert "through 2 tone-mapping operators" in alt_of(sheet)
    assert "reinhard: Q" in alt_of(sheet) and "curves: Q" in alt_of(sheet)


def test_compare_reduces_a_large_map_to_the_given_size(map_file, tmp_path):
    sheet = tmp_path / "sheet.png"
    assert hdrlab("compare", map_file, "-o", sheet, "--operators", "reinhard", "--size", 32) == 0
    assert "32 x 24" in alt_of(sheet)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--operators", "reinhard,magic"], "magic"),
        (["--operators", "reinhard,"], "got ''"),
        (["--size", "1"], "--size"),
        (["--gamut", "best"], "--gamut"),
        (["-o", "sheet.jpg"], ".png"),
        (["-o", "missing/sheet.png"], "missing"),
    ],
)
def test_bad_input_of_compare_is_a_one_line_error(
    options, message, map_file, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    code, out, complaint = hdrlab("compare", map_file, "-o", "sheet.png", *options, capsys=capsys)
    assert code == 2 and out == "" and complaint.count("\n") == 1 and message in complaint
    assert list(tmp_path.iterdir()) == [map_file]


def test_compare_repairs_invalid_values_with_a_note(tmp_path, capsys):
    broken = tmp_path / "broken.pfm"
    sheet = tmp_path / "sheet.png"
    pixels = np.array([[1, np.nan, 3], [np.inf, 2, 4]], "<f4")
    broken.write_bytes(b"Pf\n3 2\n-1.0\n" + pixels.tobytes())
    code, _, note = hdrlab("compare", broken, "-o", sheet, "--operators", "reinhard", capsys=capsys)
    assert code == 0 and "1 unknown pixels, 1 infinite values" in note and sheet.exists()


class Terminal(io.StringIO):
    """A terminal that records what is written to it."""

    def isatty(self):
        return True


def test_elapsed_shows_seconds_and_clears_the_line():
    terminal = Terminal()
    with elapsed("tone mapping", stream=terminal, delay=0.01):
        deadline = time.monotonic() + 300
        while terminal.getvalue().count("\rtone mapping: ") < 2 and time.monotonic() < deadline:
            time.sleep(0.01)
    output = terminal.getvalue()
    lines = re.findall(r"\rtone mapping: \d+ s", output)
    assert len(lines) >= 2 and output.startswith(lines[0] + lines[1])
    assert output.endswith(lines[-1] + "\r" + " " * (len(lines[-1]) - 1) + "\r")


def test_elapsed_prints_nothing_for_short_work_or_into_a_pipe():
    terminal = Terminal()
    pipe = io.StringIO()
    with elapsed("tone mapping", stream=terminal):
        pass
    with elapsed("tone mapping", stream=pipe, delay=0):
        time.sleep(0.02)
    assert terminal.getvalue() == pipe.getvalue() == ""


def test_elapsed_clears_the_line_after_an_error():
    terminal = Terminal()
    with pytest.raises(ValueError, match="bad"), elapsed("work", stream=terminal, delay=0.001):
        time.sleep(0.05)
        raise ValueError("bad")
    assert terminal.getvalue().endswith(" \r")
