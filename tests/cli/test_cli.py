"""The command line of hdrlab: outputs, options, messages and exit codes."""

import errno
import os
import re
import subprocess
import sys

import cv2
import numpy as np
import pytest
from PIL import Image, TiffImagePlugin
from PIL.ExifTags import Base

from hdrlab import cli, scenes
from hdrlab.capture import camera
from hdrlab.core.colour import luminance
from hdrlab.errors import InputError
from hdrlab.io import radiance
from hdrlab.io.maps.layers import read_layers
from hdrlab.io.photos import read_photo, write_picture
from hdrlab.pipeline import pictures
from hdrlab.show.pages.wording import describe_agreement, describe_map


def hdrlab(*arguments, capsys=None):
    """Run the command in this process; return its exit code, and its output if `capsys` is passed."""
    with pytest.raises(SystemExit) as stop:
        cli.run([str(argument) for argument in arguments])
    code = stop.value.code or 0
    return (code, *capsys.readouterr()) if capsys else code


@pytest.fixture
def photographs(tmp_path):
    """A folder of four photographs and the list of their times."""
    bracket = camera.shoot(
        scenes.room((96, 144)), [0.01, 0.04, 0.16, 0.64], camera.Camera(sensitivity=0.05), rng=1
    )
    folder = tmp_path / "photographs"
    folder.mkdir()
    lines = ["file,exposure_time_s"]
    for j, (image, seconds) in enumerate(zip(bracket.images, bracket.times, strict=True)):
        write_picture(folder / f"frame{j}.png", image)
        lines.append(f"frame{j}.png,{seconds}")
    times = tmp_path / "times.csv"
    times.write_text("\n".join(lines))
    return folder, times


@pytest.fixture
def map_file(tmp_path):
    file = tmp_path / "scene.exr"
    radiance.write_radiance(file, scenes.room((48, 64)))
    return file


def test_python_m_hdrlab_is_the_same_command():
    process = subprocess.run(
        [sys.executable, "-m", "hdrlab", "--version"], capture_output=True, text=True, check=True
    )
    assert process.stdout.startswith("hdrlab, version ")


@pytest.mark.parametrize("arguments", [["--help"], ["assemble", "--help"], ["demo", "-h"]])
def test_help_imports_no_libraries_and_nothing_of_the_course(arguments):
    code = (
        "import sys; from hdrlab import cli\n"
        f"try: cli.run({arguments!r})\n"
        "except SystemExit: pass\n"
        "print(*sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    unused = {
        "numpy",
        "scipy",
        "matplotlib",
        "PIL",
        "sqlite3",
        "tomllib",
        "concurrent.futures",
        "hdrlab.course.plan",
        "hdrlab.course.gallery.store",
        "hdrlab.io",
    }
    assert not unused & {*done.stdout.split()}


def test_importing_hdrlab_imports_no_chapter():
    code = "import sys, hdrlab; sys.exit(any(name.startswith(('hdrlab.', 'numpy')) for name in sys.modules))"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True).returncode == 0


@pytest.mark.papers
def test_assemble_imports_no_plots_and_no_unused_parts_of_scipy(photographs, tmp_path):
    folder, times = photographs
    arguments = ["assemble", str(folder), "--times", str(times), "-o", str(tmp_path / "room.hdr")]
    code = (
        "import sys; from hdrlab import cli\n"
        f"try: cli.run({[*arguments, '--picture', str(tmp_path / 'room.png')]!r})\n"
        "except SystemExit as done: assert not done.code\n"
        "print(*sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "numpy" in done.stdout.split()
    unused = {
        "scipy.ndimage",
        "scipy.fft",
        "scipy.linalg",
        "scipy.optimize",
        "matplotlib",
        "skimage",
        "sqlite3",
        "hdrlab.course.plan",
    }
    assert not unused & {*done.stdout.split()}


def test_range_of_a_large_map_is_measured_on_a_sample():
    E = np.exp(np.random.default_rng(0).normal(0, 2, (1300, 1500))).astype(np.float32)
    assert describe_map(E) == f"1500 x 1300, {scenes.decades(E):.1f} decades"


def test_assemble_writes_map_picture_and_report_from_a_folder(photographs, tmp_path, capsys):
    folder, times = photographs
    out = tmp_path / "room.hdr"
    picture = tmp_path / "room.png"
    report = tmp_path / "report"
    code, output, _ = hdrlab(
        "assemble",
        folder,
        "-o",
        out,
        "--times",
        times,
        "--picture",
        picture,
        "--report",
        report,
        capsys=capsys,
    )
    assert code == 0 and str(out) in output
    E = radiance.read_radiance(out)
    assert read_photo(picture).shape == E.shape
    assert "<html" in (report / "report.html").read_text(encoding="utf8")


@pytest.mark.parametrize(("error", "code"), [(InputError("no"), 2), (KeyboardInterrupt(), 130)])
def test_map_is_complete_although_its_picture_fails_or_is_interrupted(
    error, code, photographs, tmp_path, monkeypatch
):
    def fail(*_, **__):
        raise error

    folder, times = photographs
    plain = tmp_path / "plain.hdr"
    out = tmp_path / "room.hdr"
    picture = tmp_path / "room.png"
    assert hdrlab("assemble", folder, "-o", plain, "--times", times) == 0
    monkeypatch.setattr(pictures, "develop_and_describe", fail)
    assert hdrlab("assemble", folder, "-o", out, "--times", times, "--picture", picture) == code
    assert out.read_bytes() == plain.read_bytes() and not picture.exists()


def test_error_in_writing_the_map_is_reported_although_the_picture_is_written(
    photographs, tmp_path, capsys, monkeypatch
):
    def fail(*_, **__):
        raise OSError(errno.ENOSPC, "disk full", str(out))

    folder, times = photographs
    out = tmp_path / "room.hdr"
    picture = tmp_path / "room.png"
    monkeypatch.setattr(radiance, "write_radiance", fail)
    code, _, error = hdrlab(
        "assemble", folder, "-o", out, "--times", times, "--picture", picture, capsys=capsys
    )
    assert code == 2 and "room.hdr" in error and "disk full" in error
    assert read_photo(picture).ndim == 3 and not out.exists()


@pytest.mark.papers
def test_photos_may_be_named_one_by_one_in_any_order(photographs, tmp_path):
    folder, times = photographs
    files = sorted(folder.iterdir(), reverse=True)
    assert (
        hdrlab("assemble", folder, "-o", tmp_path / "a.pfm", "--times", times, "--align", "none")
        == 0
    )
    assert (
        hdrlab("assemble", *files, "-o", tmp_path / "b.pfm", "--times", times, "--align", "none")
        == 0
    )
    assert (tmp_path / "a.pfm").read_bytes() == (tmp_path / "b.pfm").read_bytes()


def test_photos_without_times_get_relative_ones_with_advice(photographs, tmp_path, capsys):
    code, _, notes = hdrlab("assemble", photographs[0], "-o", tmp_path / "x.hdr", capsys=capsys)
    assert code == 0
    assert "--times FILE" in notes and "--stops" in notes
    assert any(line.startswith("warning: ") and "relative" in line for line in notes.splitlines())
    assert (tmp_path / "x.hdr").exists()


def test_assemble_prints_one_line_if_nothing_is_wrong_and_details_only_on_request(
    photographs, tmp_path, capsys
):
    folder, times = photographs
    (folder / "times.csv").write_text(times.read_text())
    out = tmp_path / "x.hdr"
    picture = tmp_path / "x.png"
    arguments = ["assemble", folder, "-o", out, "--picture", picture, "--report", tmp_path / "page"]
    code, output, remarks = hdrlab(*arguments, capsys=capsys)
    assert code == 0 and remarks == ""
    assert output.startswith("OK") and output.count("\n") == 1
    assert str(out) in output and str(picture) in output and "report.html" in output
    _, verbose_said, remarks = hdrlab(*arguments, "--verbose", capsys=capsys)
    assert verbose_said == output
    assert "times.csv" in remarks and "share" in remarks
    page = (tmp_path / "page/report.html").read_text(encoding="utf8")
    assert "times.csv" in page


def test_assemble_does_not_print_ok_if_there_are_warnings(photographs, tmp_path, capsys):
    folder, times = photographs
    wrong = tmp_path / "wrong.csv"
    rows = times.read_text().splitlines()
    name, seconds = rows[-2].rsplit(",", 1)
    wrong.write_text("\n".join([*rows[:-2], f"{name},{4 * float(seconds)}", rows[-1]]))
    arguments = ["assemble", folder, "--times", wrong, "--keep-times", "-o", tmp_path / "x.hdr"]
    code, output, remarks = hdrlab(*arguments, capsys=capsys)
    assert code == 0 and "warning: " in remarks
    assert not output.startswith("OK") and "warning" in output and "x.hdr" in output


@pytest.mark.papers
def test_doubtful_map_is_written_with_warnings_and_fails_only_with_strict(
    photographs, tmp_path, capsys
):
    folder, times = photographs
    # of one, the others left it out
    text = times.read_text().replace("frame1.png,0.04", "frame1.png,0.02")
    times.write_text(text.replace("frame2.png,0.16", "frame2.png,0.3"))
    page = tmp_path / "page"
    common = ["assemble", folder, "--times", times, "--keep-times", "-o"]
    for out in (tmp_path / "x.hdr", tmp_path / "x.exr", tmp_path / "x.pfm"):
        code, _, errors = hdrlab(*common, out, "--report", page, capsys=capsys)
        warnings = [line for line in errors.splitlines() if line.startswith("warning: ")]
        assert code == 0 and 1 <= len(warnings) <= 3
        about_times = [line for line in warnings if "exposure times" in line]
        assert any("frame2.png" in line for line in about_times)
        assert "exposure times" in (page / "report.html").read_text(encoding="utf8")
        about = hdrlab("info", out, capsys=capsys)[1]
        assert ("warning: " in about) == (out.suffix != ".pfm")
        assert radiance.read_radiance(out).any()
    assert hdrlab(*common, tmp_path / "x.hdr", "--strict") == 3
    assert cv2.imread(str(tmp_path / "x.hdr"), cv2.IMREAD_UNCHANGED).any()


@pytest.mark.papers
def test_uncertainty_writes_the_map_and_its_standard_deviation_as_layers(
    photographs, tmp_path, capsys
):
    folder, times = photographs
    out = tmp_path / "x.pfm"
    both = tmp_path / "sure.exr"
    page = tmp_path / "page"
    code, output, _ = hdrlab(
        *("assemble", folder, "--times", times, "-o", out, "--uncertainty", both, "--report", page),
        capsys=capsys,
    )
    match = re.search(r"half of the pixels .* ± 0\.0\d+ stops, 95 % to ± 0\.\d+", output)
    assert code == 0 and str(both) in output and match
    words = match[0]
    E, s = read_layers(both).values()
    assert np.array_equal(E, radiance.read_radiance(both)) and E.shape == s.shape
    assert np.allclose(E, radiance.read_radiance(out))
    assert 0 < np.median((s / E)[np.isfinite(s)]) < 0.1
    about = hdrlab("info", both, capsys=capsys)[1]
    assert "layers" in about and "radiance, standard deviation" in about and words in about
    assert words in (page / "report.html").read_text(encoding="utf8").replace("\u00a0", " ")


def test_uncertainty_rejects_other_formats_than_exr_before_the_work(photographs, tmp_path, capsys):
    folder, times = photographs
    code, _, errors = hdrlab(
        *(
            "assemble",
            folder,
            "--times",
            times,
            "-o",
            tmp_path / "x.pfm",
            "--uncertainty",
            tmp_path / "s.hdr",
        ),
        capsys=capsys,
    )
    assert code == 2
    assert errors.count("\n") == 1
    assert ".exr" in errors
    assert not (tmp_path / "x.pfm").exists()


def test_map_without_warnings_has_none_in_its_header_and_passes_strict(
    photographs, tmp_path, capsys
):
    folder, times = photographs
    code, _, errors = hdrlab(
        "assemble", folder, "-o", tmp_path / "x.hdr", "--times", times, "--strict", capsys=capsys
    )
    assert code == 0 and "warning" not in errors
    assert b"warning" not in (tmp_path / "x.hdr").read_bytes()[:500]


@pytest.mark.papers
def test_unknown_times_can_be_steps_or_estimated_from_the_pixels(photographs, tmp_path, capsys):
    folder, _ = photographs
    steps = tmp_path / "steps.pfm"
    pixels = tmp_path / "pixels.pfm"
    code, _, errors = hdrlab("assemble", folder, "-o", steps, "--stops", 2, capsys=capsys)
    assert code == 0 and "warning" not in errors
    code, _, errors = hdrlab("assemble", folder, "-o", pixels, "--times", "estimate", capsys=capsys)
    assert code == 0 and "relative exposure times" in errors and "--stops" in errors


def test_list_of_times_in_the_folder_is_used(photographs, tmp_path, capsys):
    folder, times = photographs
    (folder / "readme.txt").write_text("Photographs of a room")
    (folder / "times.txt").write_text(times.read_text())
    code, _, errors = hdrlab("assemble", folder, "-v", "-o", tmp_path / "x.pfm", capsys=capsys)
    assert code == 0 and "times.txt" in errors


def test_folders_named_like_files_beside_the_photos_are_skipped(photographs, tmp_path, capsys):
    folder, times = photographs
    for name in ("a.csv", "old.txt", "copy.png", "x.jpg", "x.hdr", "y.dng"):
        (folder / name).mkdir()
    (folder / "b.txt").write_bytes(b"\xff\xfe")
    (folder / "times.csv").write_text(times.read_text())
    code, _, details = hdrlab("assemble", folder, "-v", "-o", tmp_path / "x.pfm", capsys=capsys)
    assert code == 0
    assert "times.csv" in details


@pytest.mark.papers
@pytest.mark.parametrize("form", ["{:g}", "{:g} s"])
@pytest.mark.parametrize("power", [1, -1])
def test_pixels_decide_whether_numbers_in_a_list_are_seconds_or_1_over_seconds(
    photographs, tmp_path, form, power, capsys
):
    folder, times = photographs
    exposures = [line.split(",") for line in times.read_text().splitlines()[1:]]
    rows = [f"{name} {form.format(float(t) ** power)}" for name, t in exposures]
    (tmp_path / "list.txt").write_text("\n".join(rows))
    wrong = power < 0 and " s" in form
    out = tmp_path / "x.pfm"
    list_options = ["--times", tmp_path / "list.txt"]
    code, _, errors = hdrlab("assemble", folder, "-o", out, *list_options, capsys=capsys)
    assert code == 0
    if wrong:
        assert "darker photo" in errors and "relative" in errors
    else:
        assert hdrlab("assemble", folder, "-o", tmp_path / "y.pfm", "--times", times) == 0
        assert np.allclose(
            radiance.read_radiance(out), radiance.read_radiance(tmp_path / "y.pfm"), rtol=1e-3
        )


def test_times_in_the_wrong_order_are_estimated_and_to_keep_them_is_an_error(
    photographs, tmp_path, capsys
):
    folder, times = photographs
    text = times.read_text().replace("0.01", "x").replace("0.64", "0.01").replace("x", "0.64")
    times.write_text(text)
    out = tmp_path / "x.hdr"
    options = ["assemble", folder, "-o", out, "--times", times]
    code, _, errors = hdrlab(*options, "--keep-times", capsys=capsys)
    assert code == 2 and "longer exposure is the darker" in errors and "--times estimate" in errors
    assert not out.exists()
    code, _, errors = hdrlab(*options, capsys=capsys)
    assert code == 0 and "longer exposure is the darker" in errors and "estimated" in errors
    assert hdrlab("assemble", folder, "-o", out, "--times", "estimate") == 0


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["assemble", "nowhere", "-o", "x.hdr"], "nowhere"),
        (["assemble", "nowhere"], "nowhere does not exist"),
        (["assemble", "nowhere", "-o", "x.bmp"], ".hdr"),
        (["tonemap", "nowhere.hdr", "-o", "x.png"], "nowhere.hdr"),
        (["convert", "nowhere.hdr", "-o", "x.exr"], "nowhere.hdr"),
        (["info", "nowhere.jpg"], "nowhere.jpg"),
        (["assemble", "nowhere", "-o", "x.hdr", "--mask", "blue"], "RRGGBB"),
        (["tonemap"], "Missing argument"),
        (["frobnicate"], "frobnicate"),
        (["assemble", "nowhere", "-o", "x.hdr", "--response", "magic"], "magic"),
    ],
)
def test_bad_input_is_a_one_line_error_with_exit_code_2(
    arguments, expected, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    code, output, complaint = hdrlab(*arguments, capsys=capsys)
    assert code == 2 and output == ""
    assert complaint.startswith("hdrlab: ") and complaint.count("\n") == 1 and expected in complaint
    assert list(tmp_path.iterdir()) == []


def test_set_changes_an_operators_settings_by_name(map_file, tmp_path):
    dark = tmp_path / "dark.png"
    bright = tmp_path / "bright.png"
    assert hdrlab("tonemap", map_file, "-o", dark, "--set", "key=0.09") == 0
    assert hdrlab("tonemap", map_file, "-o", bright, "--set", "key=0.72") == 0
    assert read_photo(dark).mean() < read_photo(bright).mean() - 10


@pytest.mark.parametrize(
    ("setting", "expected"), [("kee=1", "key"), ("key", "NAME=VALUE"), ("key=bright", "key")]
)
def test_set_rejects_unknown_settings(setting, expected, map_file, tmp_path, capsys):
    code, _, complaint = hdrlab(
        "tonemap", map_file, "-o", tmp_path / "x.png", "--set", setting, capsys=capsys
    )
    assert code == 2 and expected in complaint and not (tmp_path / "x.png").exists()


@pytest.mark.parametrize("suffix", [".pfm", ".exr"])
def test_convert_is_lossless_between_float_formats(suffix, map_file, tmp_path):
    assert hdrlab("convert", map_file, "-o", tmp_path / f"b{suffix}") == 0
    assert np.array_equal(
        radiance.read_radiance(tmp_path / f"b{suffix}"), radiance.read_radiance(map_file)
    )


def write_pfm(file, pixels):
    """Write a .pfm file with any values (H, W, 3); `write_radiance` accepts only radiance."""
    file.write_bytes(
        b"PF\n%d %d\n-1.0\n" % (pixels.shape[1], pixels.shape[0]) + pixels.astype("<f4").tobytes()
    )


def test_invalid_values_of_a_map_are_repaired_with_a_note(tmp_path, capsys):
    file = tmp_path / "x.pfm"
    out = tmp_path / "x.png"
    pixels = np.ones((4, 5, 3))
    pixels[0, 0, 0] = np.nan
    pixels[1, 1, 1] = np.inf
    pixels[2, 2, 2] = -0.1
    pixels[3, 3] = -1
    write_pfm(file, pixels)
    counts = ("1 unknown", "1 infinite", "1 pixels with a negative channel", "1 pixels below black")
    for command in (["tonemap", file, "-o", out], ["convert", file, "-o", tmp_path / "y.exr"]):
        code, _, note = hdrlab(*command, capsys=capsys)
        assert code == 0
        assert note.startswith(f"note: {file}") and note.count("\n") == 1
        assert all(count in note for count in counts)
    assert out.exists() and np.isfinite(radiance.read_radiance(tmp_path / "y.exr")).all()
    assert hdrlab("convert", tmp_path / "y.exr", "-o", file, capsys=capsys)[2] == ""
    assert (
        "nothing" in hdrlab("convert", tmp_path / "y.exr", "-o", file, "--clean", capsys=capsys)[1]
    )


@pytest.mark.parametrize("value", [np.nan, np.inf, -1.0])
def test_mostly_invalid_map_is_rejected_without_clean(value, tmp_path, capsys):
    file = tmp_path / "x.pfm"
    out = tmp_path / "out.pfm"
    pixels = np.ones((4, 5, 3))
    pixels[:2] = value
    write_pfm(file, pixels)
    code, _, complaint = hdrlab("convert", file, "-o", out, capsys=capsys)
    assert code == 2
    assert str(file) in complaint
    assert "20 pixels" in complaint
    assert "--clean" in complaint
    assert not out.exists() and hdrlab("convert", file, "-o", out, "--clean") == 0
    assert np.isfinite(radiance.read_radiance(out)).all()


def test_tonemap_offers_both_ways_for_out_of_gamut_colors(tmp_path, capsys):
    E = np.float32([0.1, 0.3, 4.0]) * np.geomspace(0.1, 30, 20 * 30).reshape(20, 30, 1).astype(
        np.float32
    )
    radiance.write_radiance(tmp_path / "blue.exr", E)
    pictures = {}
    for way in ("ratio", "hue"):
        out = tmp_path / f"{way}.png"
        assert hdrlab("tonemap", tmp_path / "blue.exr", "-o", out, "--gamut", way) == 0
        pictures[way] = read_photo(out).astype(int)
    brightest = {way: picture[-1, -1] for way, picture in pictures.items()}
    assert brightest["ratio"][2] == 255 > brightest["ratio"][0] + 20
    cyan = {way: levels[1] - levels[0] for way, levels in brightest.items()}
    assert cyan["hue"] < cyan["ratio"] / 2, "clipped, a blue turns"
    code, _, complaint = hdrlab(
        "tonemap", tmp_path / "blue.exr", "-o", tmp_path / "x.png", "--gamut", "lab", capsys=capsys
    )
    assert code == 2 and "'hue', 'ratio'" in complaint


def test_info_states_range_size_and_unit_of_a_map_and_whether_a_photo_states_its_exposure(
    photographs, tmp_path, capsys
):
    E = np.geomspace(1, 1024, 64 * 64).reshape(64, 64)
    radiance.write_radiance(tmp_path / "known.hdr", E, luminance_of_unit=2.5)
    radiance.write_radiance(tmp_path / "relative.pfm", E)
    photo = min(path for path in photographs[0].iterdir() if path.suffix == ".png")
    files = [tmp_path / "known.hdr", tmp_path / "relative.pfm", photo]
    code, output, _ = hdrlab("info", *files, capsys=capsys)
    assert code == 0 and output.count("10.0 stops") == 2 and "2.5 cd/m^2" in output
    assert "relative\n" in output and "exposure     the file states none" in output


def test_hdrlab_alone_prints_the_help_in_sections_with_every_command_once(capsys):
    code, output, complaint = hdrlab(capsys=capsys)
    assert code == 0 and complaint == ""
    for heading in ("Photographs:", "Learn:", "Teach:", "Project:"):
        assert heading in output
    for name in cli.main.commands:
        assert len(re.findall(rf"^  {name} ", output, re.M)) == 1, name


def test_info_states_format_and_size(map_file, photographs, capsys):
    code, output, _ = hdrlab(
        "info", map_file, next(iter(sorted(photographs[0].iterdir()))), capsys=capsys
    )
    assert code == 0 and "OpenEXR" in output and "PNG" in output
    assert output.split()[output.split().index("width") + 1] == "64"


def test_failed_run_keeps_the_old_file(photographs, tmp_path):
    out = tmp_path / "room.hdr"
    out.write_bytes(b"precious")
    assert hdrlab("assemble", photographs[0], "-o", out, "--times", "missing.csv") == 2
    assert out.read_bytes() == b"precious"


def test_ctrl_c_is_one_line_with_exit_code_130(monkeypatch, tmp_path, capsys):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("hdrlab.io.album.select", interrupted)
    code, output, complaint = hdrlab("assemble", tmp_path, "-o", tmp_path / "x.hdr", capsys=capsys)
    assert (code, output, complaint.strip()) == (130, "", "hdrlab: interrupted")
    assert list(tmp_path.iterdir()) == []


def test_ctrl_c_while_a_class_is_created_is_one_line(monkeypatch, tmp_path, capsys):
    class Stopped:
        def __set_name__(self, owner, name):
            raise KeyboardInterrupt

    monkeypatch.setattr(
        "hdrlab.io.album.select", lambda *_, **__: type("Axes", (), {"a": Stopped()})
    )
    code, output, complaint = hdrlab("assemble", tmp_path, "-o", tmp_path / "x.hdr", capsys=capsys)
    assert (code, output, complaint.strip()) == (130, "", "hdrlab: interrupted")


def test_ctrl_c_while_a_c_extension_is_loaded_is_one_line(monkeypatch, tmp_path, capsys):
    def stopped(*_, **__):  # as pybind11 tells it
        raise ImportError("initialization failed") from KeyboardInterrupt()

    monkeypatch.setattr("hdrlab.io.album.select", stopped)
    code, output, complaint = hdrlab("assemble", tmp_path, "-o", tmp_path / "x.hdr", capsys=capsys)
    assert (code, output, complaint.strip()) == (130, "", "hdrlab: interrupted")


WHILE_LOADING = """
import runpy, sys
class Finder:
    def find_spec(name, path=None, target=None):
        if name == "hdrlab.cli.maps":
            {raised}
sys.meta_path.insert(0, Finder)
runpy.run_module("hdrlab", run_name="__main__")
"""


@pytest.mark.parametrize(
    ("raised", "code", "complaint"),
    [
        ("raise KeyboardInterrupt", 130, "hdrlab: interrupted"),
        (
            "raise ImportError('initialization failed') from KeyboardInterrupt()",
            130,
            "hdrlab: interrupted",
        ),
        ("raise ImportError('a mistake of ours')", 1, "ImportError: a mistake of ours"),
    ],
)
def test_ctrl_c_during_imports_is_one_line_and_an_import_error_is_not(raised, code, complaint):
    ended = subprocess.run(
        [sys.executable, "-c", WHILE_LOADING.format(raised=raised), "info"],
        capture_output=True,
        text=True,
        encoding="utf8",
    )
    assert (ended.returncode, ended.stderr.splitlines()[-1]) == (code, complaint)
    assert code == 1 or len(ended.stderr.splitlines()) == 1


@pytest.mark.parametrize("kind", [ValueError, RuntimeError, ImportError, KeyError])
def test_bug_shows_its_traceback_and_has_exit_code_1(kind, monkeypatch, tmp_path, capsys):
    def broken(*_, **__):
        raise kind("a mistake of ours")

    monkeypatch.setattr("hdrlab.io.album.select", broken)
    code, _, complaint = hdrlab("assemble", tmp_path, "-o", tmp_path / "x.hdr", capsys=capsys)
    assert code == 1 and complaint.startswith("Traceback") and "a mistake of ours" in complaint
    closing_line = complaint.splitlines()[-1]
    assert closing_line.startswith("hdrlab: ") and "bug in hdrlab" in closing_line


@pytest.mark.parametrize(
    ("command", "reader", "advice"),
    [
        ("assemble", "hdrlab.io.album.select", "fewer or smaller photos"),
        ("compare", "hdrlab.io.radiance.read_sanitized", "a smaller --size"),
        ("tonemap", "hdrlab.io.radiance.read_sanitized", "close other programs"),
    ],
)
def test_memory_error_is_one_line_with_the_need_and_advice_for_the_command(
    command, reader, advice, monkeypatch, tmp_path, capsys
):
    def exhausted(*_, **__):
        raise MemoryError("Unable to allocate 9.00 GiB for an array with shape (9,)")

    monkeypatch.setattr(reader, exhausted)
    out = tmp_path / ("x.hdr" if command == "assemble" else "x.png")
    code, _, complaint = hdrlab(command, tmp_path, "-o", out, capsys=capsys)
    assert code == 2 and complaint.count("\n") == 1
    assert advice in complaint and "9.00 GiB" in complaint


@pytest.mark.parametrize("words", ["--debug info missing.jpg", "info missing.jpg --debug"])
def test_debug_shows_the_traceback_of_bad_input(words, monkeypatch, tmp_path, capsys):
    monkeypatch.chdir(tmp_path)
    code, _, complaint = hdrlab(*words.split(), capsys=capsys)
    assert code == 2 and "Traceback" in complaint
    assert "missing.jpg" in complaint.splitlines()[-1]


def test_lab_copies_notebooks_and_keeps_the_readers_changes(tmp_path, capsys):
    copy = tmp_path / "mine"
    assert hdrlab("lab", "-o", copy, "--copy-only") == 0
    mine = [copy / "notebooks/04_response_gsolve.ipynb", copy / "assignments/hw2.ipynb"]
    for notebook in mine:
        notebook.write_text("mine")
    code, output, _ = hdrlab("lab", "-o", copy, "--copy-only", capsys=capsys)
    assert code == 0 and "0 new" in output
    assert [notebook.read_text() for notebook in mine] == ["mine", "mine"]


@pytest.mark.papers
def test_lab_opens_the_first_notebook(tmp_path, monkeypatch):
    called = []
    monkeypatch.setenv("JUPYTER_CONFIG_PATH", "")  # which the command sets
    monkeypatch.setattr("jupyterlab.labapp.LabApp.launch_instance", called.append)
    assert hdrlab("lab", "-o", tmp_path / "mine", "--", "--port", "9000") == 0
    first = next(part for part in called[0] if part.startswith("--LabApp.default_url="))
    assert (tmp_path / "mine" / first.removeprefix("--LabApp.default_url=/lab/tree/")).is_file()
    assert called[0][-2:] == ["--port", "9000"]


def test_lab_saves_widget_state_and_disables_news(tmp_path, monkeypatch):
    server = pytest.importorskip("jupyterlab_server.config")
    monkeypatch.setenv("JUPYTER_CONFIG_PATH", str(tmp_path / "own"))
    monkeypatch.setattr("jupyterlab.labapp.LabApp.launch_instance", lambda options: None)
    assert hdrlab("lab", "-o", tmp_path / "mine") == 0
    settings = server.ConfigManager(config_dir_name="labconfig").get("default_setting_overrides")
    assert settings["@jupyter-widgets/jupyterlab-manager:plugin"] == {"saveState": True}
    assert settings["@jupyterlab/apputils-extension:notification"]["fetchNews"] == "false"
    assert os.environ["JUPYTER_CONFIG_PATH"].endswith(os.pathsep + str(tmp_path / "own"))


def test_agreement_that_cannot_be_measured_is_not_stated_in_stops():
    assert "0.012 stops" in describe_agreement(0.0123, 3)
    assert not re.search(r"\d|nan|stops", describe_agreement(float("nan"), 3))


@pytest.mark.parametrize("suffix", [".exr", ".hdr", ".tif"])
def test_tonemap_keeps_a_night_dark_that_its_map_states(tmp_path, suffix):
    night = tmp_path / f"night{suffix}"
    day = tmp_path / f"day{suffix}"
    converted = tmp_path / f"converted{suffix}"
    E = scenes.room((96, 144))
    radiance.write_radiance(night, E, luminance_of_unit=1e-4)
    radiance.write_radiance(day, E)
    assert hdrlab("convert", night, "-o", converted) == 0
    pictures_of_maps = []
    for source in (night, converted, day):
        assert hdrlab("tonemap", source, "-o", tmp_path / "x.png") == 0
        pictures_of_maps.append(read_photo(tmp_path / "x.png").astype(int))
    assert np.abs(pictures_of_maps[0] - pictures_of_maps[1]).max() <= 2
    assert pictures_of_maps[0].mean() < pictures_of_maps[2].mean() - 10


@pytest.mark.parametrize("is_complete", [True, False])
def test_assemble_and_tonemap_make_the_same_picture_of_a_night(tmp_path, capsys, is_complete):
    scene = scenes.room((96, 144))
    taken = camera.shoot(scene, camera.times_around(scene, 4), rng=1)
    for j, image in enumerate(taken.images):
        exif = Image.Exif()
        seconds = TiffImagePlugin.IFDRational(4 ** (j + 1), 8)
        tags = {Base.ExposureTime: seconds}
        if is_complete:
            tags |= {Base.FNumber: 4, Base.ISOSpeedRatings: 100}
        exif[Base.ExifOffset] = tags
        Image.fromarray(image).save(tmp_path / f"{j}.jpg", exif=exif, quality=98)
    photos = sorted(tmp_path.glob("*.jpg"))
    out = tmp_path / "x.exr"
    first = tmp_path / "1.png"
    second = tmp_path / "2.png"
    code, output, _ = hdrlab("assemble", *photos, "-o", out, "--picture", first, capsys=capsys)
    assert code == 0 and "kept dark" in output
    assert ("at most EV" in output) == (not is_complete)
    assert hdrlab("tonemap", out, "-o", second) == 0
    assert np.array_equal(read_photo(first), read_photo(second))


def test_calibrate_scales_the_map_by_one_meter_reading(photographs, tmp_path, capsys):
    folder, times = photographs
    arguments = ["assemble", folder, "--times", times, "--align", "none", "-o", tmp_path / "a.exr"]
    code, _, errors = hdrlab(*arguments, "--calibrate", "20,30=50", capsys=capsys)
    L = luminance(radiance.read_radiance(tmp_path / "a.exr"))
    truth = luminance(scenes.room((96, 144)))
    assert code == 0 and "50 cd/m^2 at 20,30" in errors
    assert np.isclose(L[29:32, 19:22].mean(), 50, rtol=1e-3)
    assert np.isclose(np.median(L / truth), 50 / truth[29:32, 19:22].mean(), rtol=0.15)


@pytest.mark.parametrize(
    ("reading", "expected"),
    [("20;30=50", "expected X,Y=CD"), ("900,3=50", "144 x 96"), ("20,30=0", "got 0 at")],
)
def test_invalid_meter_readings_are_rejected_and_nothing_is_written(
    photographs, tmp_path, capsys, reading, expected
):
    folder, times = photographs
    arguments = [
        "assemble",
        folder,
        "--times",
        times,
        "-o",
        tmp_path / "a.exr",
        "--calibrate",
        reading,
    ]
    code, _, errors = hdrlab(*arguments, capsys=capsys)
    assert code == 2 and expected in errors and not (tmp_path / "a.exr").exists()


@pytest.mark.parametrize(
    ("arguments", "new_name"),
    [
        (["assemble", "x.jpg", "-o", "x.hdr", "--tonemap", "ward"], "--operator"),
        (["assemble", "x.jpg", "-o", "x.hdr", "--times", "stated"], "--keep-times"),
        (["tonemap", "x.hdr", "-o", "x.png", "--way", "hue"], "--gamut"),
        (["calibrate", "x.jpg", "--estimate-times"], "--correct-times"),
        (["correct", "x.jpg", "-o", "y.jpg", "--way", "locus"], "--skin"),
        (["check", "hw2.py", "--page", "x.html"], "--report"),
        (["lab", "--folder", "x"], "-o"),
        (["convert", "x.hdr", "x.exr"], "'-o'"),
        (["course", "new-task", "tint", "--folder", "x"], "-o"),
    ],
)
def test_an_option_with_a_new_name_says_so(arguments, new_name, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for name in ("x.jpg", "x.hdr"):
        (tmp_path / name).write_bytes(b"")
    code, _, complaint = hdrlab(*arguments, capsys=capsys)
    assert code == 2 and new_name in complaint
