"""`hdrlab demo`: a bracket of a scene with known radiance becomes a radiance map."""

import cv2
import numpy as np
import pytest
from click.testing import CliRunner

from hdrlab import cli, demo
from hdrlab.io.radiance import read_radiance


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    out = tmp_path_factory.mktemp("demo") / "new" / "folder"
    lines = list(demo.demo_steps(out))
    return out, lines


@pytest.mark.papers
def test_demo_yields_as_many_lines_as_announced(results):
    assert len(results[1]) == demo.STEP_COUNT


def test_demo_writes_three_maps_a_picture_and_a_report(results):
    names = sorted(file.name for file in results[0].iterdir())
    assert names == ["picture.png", "radiance.exr", "radiance.hdr", "radiance.pfm", "report.html"]


def test_maps_of_the_demo_have_the_same_radiance(results):
    E = {
        suffix: read_radiance(results[0] / f"radiance{suffix}")
        for suffix in (".hdr", ".exr", ".pfm")
    }
    assert np.array_equal(E[".exr"], E[".pfm"])
    # RGBE shares one exponent, so that one decides the step
    brightest = E[".pfm"].max(axis=-1, keepdims=True)
    assert np.all(np.abs(E[".hdr"] - E[".pfm"]) <= brightest / 128)


def test_picture_of_the_demo_uses_the_range_of_the_display(results):
    picture = cv2.imread(str(results[0] / "picture.png"))
    assert picture.min() < 20 and picture.max() > 235 and 60 < picture.mean() < 200


def test_report_of_the_demo_loads_nothing(results):
    page = (results[0] / "report.html").read_text(encoding="utf8")
    assert "http://" not in page.replace("http://www.w3.org", "") and "https://" not in page
    assert page.count("<img") == page.count("alt=")


@pytest.mark.papers
def test_same_seed_gives_the_same_map_bit_for_bit(results, tmp_path):
    list(demo.demo_steps(tmp_path))
    assert (tmp_path / "radiance.pfm").read_bytes() == (results[0] / "radiance.pfm").read_bytes()


@pytest.mark.papers
def test_demo_on_real_photos_has_the_same_steps_and_no_errors_section(tmp_path):
    lines = list(demo.real_steps(tmp_path / "new"))
    assert len(lines) == demo.STEP_COUNT and lines[1].split()[:2] == ["bracket", "12"]
    assert "the frames agree to 0.0" in lines[6]
    # fmt: skip
    assert sorted(file.name for file in (tmp_path / "new").iterdir())[1:] == [
        "radiance.exr",
        "radiance.hdr",
        "radiance.pfm",
        "report.html",
    ]
    assert "median error" not in (tmp_path / "new" / "report.html").read_text("utf8")


def test_demo_real_uses_the_real_photos(tmp_path, monkeypatch):
    monkeypatch.setattr(demo, "real_steps", lambda out: iter([f"real in {out}"]))
    ran = CliRunner().invoke(cli.main, ["demo", "--real", "--out", str(tmp_path)])
    assert ran.exit_code == 0 and ran.output == f"real in {tmp_path}\n"
