"""`hdrlab score`: a radiance map compared with the truth, and the conditions of the scores."""

import re

import numpy as np
import pytest
from test_cli import hdrlab

from hdrlab import scenes
from hdrlab.io import radiance
from hdrlab.radiance import pu21, scores

TRUTH = scenes.room((32, 48))
FOUND = np.minimum(1.25 * TRUTH, np.quantile(TRUTH, 0.99)).astype(np.float32)


@pytest.fixture
def maps(tmp_path, monkeypatch):
    """Write the truth with and without a unit, and a map that is too bright and clipped."""
    monkeypatch.chdir(tmp_path)
    radiance.write_radiance("truth.exr", TRUTH)
    radiance.write_radiance("lit.exr", TRUTH, luminance_of_unit=80)
    radiance.write_radiance("found.exr", FOUND)


def run_score(capsys, *words):
    code, output, complaint = hdrlab("score", *words, capsys=capsys)
    assert code == 0 and complaint == ""
    numbers = dict(re.findall(r"^  (PSNR|log PSNR|PU-PSNR|PU-SSIM) +([\d.]+)", output, re.M))
    return {name: float(number) for name, number in numbers.items()}, output


def test_scores_are_those_of_the_library_with_the_unit_of_the_reference(maps, capsys):
    numbers, output = run_score(capsys, "found.exr", "lit.exr")
    assert numbers == {
        "PSNR": pytest.approx(scores.psnr(FOUND, TRUTH), abs=0.01),
        "log PSNR": pytest.approx(scores.log_psnr(FOUND, TRUTH), abs=0.01),
        "PU-PSNR": pytest.approx(pu21.psnr(FOUND, TRUTH, luminance_of_unit=80), abs=0.01),
        "PU-SSIM": pytest.approx(pu21.ssim(FOUND, TRUTH, luminance_of_unit=80), abs=1e-4),
    }
    assert "value 1 is 80 cd/m^2 (stated in the map)" in output and "not fitted" in output


def test_without_a_unit_there_is_no_pu21_score_and_a_way_to_get_one(maps, capsys):
    numbers, output = run_score(capsys, "found.exr", "truth.exr")
    assert set(numbers) == {"PSNR", "log PSNR"}
    assert "relative units" in output and "--peak" in output


def test_peak_is_the_luminance_of_the_brightest_value(maps, capsys):
    numbers, output = run_score(capsys, "found.exr", "truth.exr", "--peak", 4000)
    expected = scores.pu_psnr(FOUND, TRUTH, peak=4000)
    assert numbers["PU-PSNR"] == pytest.approx(expected, abs=0.01)
    assert "(from --peak), brightest value 4000 cd/m^2" in output


def test_fit_removes_a_wrong_exposure_and_says_so(maps, capsys):
    radiance.write_radiance("bright.exr", 2 * TRUTH)
    _, output = run_score(capsys, "bright.exr", "lit.exr", "--fit")
    assert "exposure fitted, bright.exr times 0.5" in output and "inf dB" in output


def test_two_units_are_converted_to_one(maps, capsys):
    radiance.write_radiance("candela.exr", 80 * FOUND, luminance_of_unit=1)
    numbers, _ = run_score(capsys, "candela.exr", "lit.exr")
    assert numbers["PU-PSNR"] == pytest.approx(
        pu21.psnr(FOUND, TRUTH, luminance_of_unit=80), abs=0.01
    )


def test_maps_of_two_sizes_cannot_be_compared(maps, capsys):
    radiance.write_radiance("small.exr", TRUTH[:16])
    code, _, complaint = hdrlab("score", "small.exr", "truth.exr", capsys=capsys)
    assert code == 2 and "48 x 16, color in small.exr" in complaint


def test_a_black_reference_is_an_error_and_no_traceback(maps, capsys):
    radiance.write_radiance("black.exr", 0 * TRUTH)
    code, _, complaint = hdrlab("score", "found.exr", "black.exr", "--peak", 100, capsys=capsys)
    assert code == 2 and "light" in complaint
