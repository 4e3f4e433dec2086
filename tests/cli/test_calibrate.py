"""`hdrlab calibrate`, and `assemble` with a curve that it saved."""

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image
from test_cli import hdrlab

from hdrlab import scenes
from hdrlab.capture import camera, responses
from hdrlab.core.metrics import response_rmse
from hdrlab.io import radiance
from hdrlab.io.photos import write_picture
from hdrlab.io.response_files import read_curve, write_curve
from hdrlab.show.plots import calibration

LINEAR = np.log(np.maximum(np.arange(256), 0.25) / 128)
TIMES = [0.01, 0.04, 0.16, 0.64]


@pytest.fixture(scope="module")
def photographs(tmp_path_factory):
    """A folder of four photographs, the list of their times, and the camera's response."""
    home = tmp_path_factory.mktemp("calibrate")
    taken = camera.shoot(
        scenes.room((144, 216)), TIMES, camera.Camera(sensitivity=0.05, response="srgb"), rng=1
    )
    (home / "photographs").mkdir()
    lines = ["file,exposure_time_s"]
    for j, (image, seconds) in enumerate(zip(taken.images, taken.times, strict=True)):
        write_picture(home / "photographs" / f"frame{j}.png", image)
        lines.append(f"frame{j}.png,{seconds}")
    (home / "times.csv").write_text("\n".join(lines))
    return home / "photographs", home / "times.csv", responses.true_g("srgb")


@pytest.mark.parametrize("suffix", [".csv", ".m"])
def test_calibrate_writes_the_curve_in_every_format(suffix, photographs, tmp_path, capsys):
    folder, times, true = photographs
    out = tmp_path / f"g{suffix}"
    code, output, _ = hdrlab("calibrate", folder, "-o", out, "--times", times, capsys=capsys)
    assert code == 0 and str(out) in output
    assert response_rmse(read_curve(out), true).max() < 1.5


def test_summary_lists_doublings_of_exposure_and_residuals(photographs, tmp_path, capsys):
    folder, times, true = photographs
    outs = [tmp_path / "g.csv", tmp_path / "g.m"]
    code, output, _ = hdrlab(
        *("calibrate", folder, "--times", times, "--response", "space"),
        *("-o", outs[0], "-o", outs[1]),
        capsys=capsys,
    )
    assert code == 0 and output.startswith("space, from 4 photos\nstops ")
    assert all(line == line.rstrip() for line in output.splitlines())
    lines = {line.split()[0]: line.split()[1:] for line in output.splitlines()}
    levels = dict(zip(lines["stops"], map(int, lines["green"]), strict=True))
    true_levels = calibration.doublings(true)
    assert levels["0"] == 128
    assert abs(levels["+1"] - true_levels[1]) < 4 and abs(levels["−2"] - true_levels[-2]) < 4
    assert float(lines["spread"][0]) < 0.1 and 0 < float(lines["residuals"][0]) < 0.1
    assert all(out.exists() for out in outs)


@pytest.mark.papers
@pytest.mark.parametrize("suffix", [".png", ".svg"])
def test_plot_contains_its_alt_text(suffix, photographs, tmp_path):
    folder, times, _ = photographs
    plot = tmp_path / f"plot{suffix}"
    assert hdrlab("calibrate", folder, "--times", times, "--plot", plot) == 0
    if suffix == ".png":
        with Image.open(plot) as image:
            assert "stops rms" in image.info["Description"] and min(image.size) > 400
    else:
        first = plot.read_bytes()
        assert b"stops rms" in first
        assert hdrlab("calibrate", folder, "--times", times, "--plot", plot) == 0
        assert plot.read_bytes() == first


def test_bracket_that_a_method_rejects_is_a_one_line_error(tmp_path, capsys):
    for j in range(2):
        write_picture(tmp_path / f"dark{j}.png", np.zeros((32, 48, 3), np.uint8))
    (tmp_path / "times.txt").write_text("dark0.png 100\ndark1.png 10\n")
    arguments = ("calibrate", tmp_path, "--times", tmp_path / "times.txt", "--align", "none")
    code, _, complaint = hdrlab(*arguments, capsys=capsys)
    assert code == 2 and complaint.count("\n") == 1 and "expected" in complaint


def test_saved_curve_can_replace_the_response_method(photographs, tmp_path):
    folder, times, true = photographs
    options = ("assemble", folder, "--times", times, "--align", "none")
    write_curve(tmp_path / "true.m", true)
    saved = tmp_path / "g.csv"
    assert hdrlab("calibrate", *options[1:], "-o", saved) == 0
    assert hdrlab(*options, "-o", tmp_path / "a.pfm", "--response", "debevec") == 0
    assert hdrlab(*options, "-o", tmp_path / "b.pfm", "--response", saved) == 0
    assert hdrlab(*options, "-o", tmp_path / "c.pfm", "--response", tmp_path / "true.m") == 0
    assert (tmp_path / "a.pfm").read_bytes() == (tmp_path / "b.pfm").read_bytes()
    with_saved_curve = radiance.read_radiance(tmp_path / "b.pfm")
    best = radiance.read_radiance(tmp_path / "c.pfm")
    assert np.median(np.abs(np.log2(with_saved_curve / best))) < 0.1


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["calibrate", "nowhere", "-o", "g.txt"], ".csv, .m"),
        (["calibrate", "nowhere", "--plot", "g.pdf"], ".svg"),
        (["calibrate", "nowhere"], "nowhere"),
        (["calibrate", "nowhere", "--response", "magic"], "magic"),
        (["assemble", "nowhere", "-o", "x.hdr", "--response", "missing.csv"], "missing.csv"),
        (["assemble", "nowhere", "-o", "x.hdr", "--response", "curve.txt"], "curve.txt"),
    ],
)
def test_bad_input_is_a_one_line_error_and_writes_nothing(
    arguments, expected, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    code, output, complaint = hdrlab(*arguments, capsys=capsys)
    assert (code, output) == (2, "") and complaint.count("\n") == 1 and expected in complaint
    assert list(tmp_path.iterdir()) == []


def test_pixel_values_of_a_linear_camera_double_with_exposure():
    levels = calibration.doublings(LINEAR)
    assert [round(levels[k], 2) for k in (-3, -2, -1, 0)] == [16, 32, 64, 128]
    assert max(levels) == 0 and min(levels) == -3
    occurs_everywhere = np.zeros((2, 1, 256))
    assert np.allclose(calibration.measure_reach(LINEAR, occurs_everywhere).stops, np.log2(25))


def test_range_of_a_response_is_stated_and_drawn_over_pixel_values_that_occur():
    g = np.stack([LINEAR, LINEAR, LINEAR], axis=1)
    g[:20] -= 20  # levels below the floor of a scanner, where a curve is an extrapolation
    medians = np.full((2, 3, 256), np.nan)
    medians[0, :, 25:200] = 0
    medians[1, 1, 20:220] = 0
    reach = calibration.measure_reach(g, medians)
    assert (reach.low, reach.high) == (25, 199)
    assert np.allclose(reach.stops, np.log2(199 / 25))
    drawn = calibration.calibration(g, medians, ["1 s", "2 s"])
    first, last = zip(*(line.get_ydata()[[0, -1]] for line in drawn.axes[0].lines), strict=True)
    assert first == (25, 20, 25) and last == (199, 219, 199)
    text = calibration.summary(g, medians, ["a", "b"])
    assert "25 and 199" in text and min(calibration.doublings(g[:, 0], 25, 199)) == -2


def test_flat_end_of_a_curve_has_no_doublings():
    g = np.minimum(LINEAR, LINEAR[200]) + np.log(128 / 80)
    assert np.isclose(calibration.doublings(g - np.log(2))[0], 160)
    assert max(calibration.doublings(g)) == 1


@pytest.mark.parametrize("channels", [(), (3,)])
def test_calibration_figure_works_for_gray_color_and_unknown_pixel_values(channels):
    g = np.broadcast_to(LINEAR.reshape(256, *[1] * len(channels)), (256, *channels))
    medians = np.full((2, (channels or (1,))[0], 256), np.nan)
    drawn = calibration.calibration(g, medians, ["0.1 s", "1 s"], title="debevec")
    assert isinstance(drawn, Figure) and len(drawn.axes) == 2 and len(drawn.axes[1].lines) == 3
