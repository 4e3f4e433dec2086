"""What a shell user may expect of the `hdrlab` command."""

import os
import re
import subprocess
import sys

import cv2
import numpy as np
import pytest

from hdrlab import cli, scenes
from hdrlab.capture import camera
from hdrlab.cli.common import describe_agreement, describe_map
from hdrlab.core.colour import luminance
from hdrlab.errors import InputError
from hdrlab.io import radiance
from hdrlab.io.maps.layers import read_layers
from hdrlab.io.photos import read_photo, write_picture
from hdrlab.pipeline import pictures


def hdrlab(*arguments, capsys=None):
    """Run the command in this process; return its exit code, and what it said where `capsys` listens."""
    with pytest.raises(SystemExit) as stop:
        cli.run([str(one) for one in arguments])
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
    said = subprocess.run(
        [sys.executable, "-m", "hdrlab", "--version"], capture_output=True, text=True, check=True
    )
    assert said.stdout.startswith("hdrlab, version ")


@pytest.mark.parametrize("arguments", [["--help"], ["assemble", "--help"], ["demo", "-h"]])
def test_help_imports_neither_numpy_nor_matplotlib(arguments):
    code = (
        "import sys; from hdrlab import cli\n"
        f"try: cli.run({arguments!r})\n"
        "except SystemExit: pass\n"
        "sys.exit(any(name in sys.modules for name in ('numpy', 'scipy', 'matplotlib', 'PIL')))"
    )
    assert subprocess.run([sys.executable, "-c", code], capture_output=True).returncode == 0


def test_importing_hdrlab_imports_no_chapter():
    code = "import sys, hdrlab; sys.exit(any(name.startswith(('hdrlab.', 'numpy')) for name in sys.modules))"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True).returncode == 0


@pytest.mark.papers
def test_assembling_loads_nothing_of_scipy_that_it_does_not_use_and_no_plots(photographs, tmp_path):
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
    }
    assert not unused & {*done.stdout.split()}


def test_the_range_of_a_large_map_is_told_by_a_sample_of_its_pixels():
    E = np.exp(np.random.default_rng(0).normal(0, 2, (1300, 1500))).astype(np.float32)
    assert describe_map(E) == f"1500 x 1300, {scenes.decades(E):.1f} decades"


def test_a_folder_becomes_a_radiance_map_a_picture_and_a_report(photographs, tmp_path, capsys):
    folder, times = photographs
    out, picture, report = tmp_path / "room.hdr", tmp_path / "room.png", tmp_path / "report"
    code, said, _ = hdrlab(
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
    assert code == 0 and str(out) in said
    E = radiance.read_radiance(out)
    assert read_photo(picture).shape == E.shape
    assert "<html" in (report / "report.html").read_text(encoding="utf8")


@pytest.mark.parametrize(("error", "code"), [(InputError("no"), 2), (KeyboardInterrupt(), 130)])
def test_the_map_is_written_whole_where_its_picture_fails_or_is_interrupted(
    error, code, photographs, tmp_path, monkeypatch
):
    def fail(*_):
        raise error

    folder, times = photographs
    plain, out, picture = (tmp_path / name for name in ("plain.hdr", "room.hdr", "room.png"))
    assert hdrlab("assemble", folder, "-o", plain, "--times", times) == 0
    monkeypatch.setattr(pictures, "develop_and_describe", fail)
    assert hdrlab("assemble", folder, "-o", out, "--times", times, "--picture", picture) == code
    assert out.read_bytes() == plain.read_bytes() and not picture.exists()


def test_a_map_that_cannot_be_written_beside_its_picture_is_an_error(photographs, tmp_path, capsys):
    folder, times = photographs
    out, picture = tmp_path / "gone" / "room.hdr", tmp_path / "room.png"
    code, _, said = hdrlab(
        "assemble", folder, "-o", out, "--times", times, "--picture", picture, capsys=capsys
    )
    assert code == 2 and "there is no folder" in said and read_photo(picture).ndim == 3


@pytest.mark.papers
def test_the_files_may_be_named_one_by_one_and_in_any_order(photographs, tmp_path):
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


def test_photographs_without_times_are_refused_with_what_to_do(photographs, tmp_path, capsys):
    code, said, complaint = hdrlab(
        "assemble", photographs[0], "-o", tmp_path / "x.hdr", capsys=capsys
    )
    assert code == 2 and said == ""
    assert complaint.startswith("hdrlab: ") and complaint.count("\n") == 1
    assert (
        "--times estimate" in complaint and "--stops 2" in complaint and "frame0.png" in complaint
    )
    assert not (tmp_path / "x.hdr").exists()


@pytest.mark.papers
def test_a_doubtful_map_is_written_with_its_doubts_and_fails_only_under_strict(
    photographs, tmp_path, capsys
):
    folder, times = photographs
    text = times.read_text().replace(
        "frame1.png,0.04", "frame1.png,0.02"
    )  # of one, the others left it out
    times.write_text(text.replace("frame2.png,0.16", "frame2.png,0.3"))
    page, common = tmp_path / "page", ["assemble", folder, "--times", times, "--keep-times", "-o"]
    for out in (tmp_path / "x.hdr", tmp_path / "x.exr", tmp_path / "x.pfm"):
        code, _, said = hdrlab(*common, out, "--report", page, capsys=capsys)
        warnings = [line for line in said.splitlines() if line.startswith("warning: ")]
        assert code == 0 and 1 <= len(warnings) <= 3
        about_times = [line for line in warnings if "exposure times" in line]
        assert any("frame2.png" in line for line in about_times)
        assert "exposure times" in (page / "report.html").read_text(encoding="utf8")
        about = hdrlab("info", out, capsys=capsys)[1]
        assert ("doubt: " in about) == (out.suffix != ".pfm")
        assert radiance.read_radiance(out).any()
    assert hdrlab(*common, tmp_path / "x.hdr", "--strict") == 3
    assert cv2.imread(str(tmp_path / "x.hdr"), cv2.IMREAD_UNCHANGED).any()


@pytest.mark.papers
def test_a_map_is_written_with_its_standard_deviation_as_a_second_layer(
    photographs, tmp_path, capsys
):
    folder, times = photographs
    out, both, page = tmp_path / "x.pfm", tmp_path / "sure.exr", tmp_path / "page"
    code, said, _ = hdrlab(
        *("assemble", folder, "--times", times, "-o", out, "--uncertainty", both, "--report", page),
        capsys=capsys,
    )
    words = next(line for line in said.splitlines() if line.startswith(str(both))).partition(": ")[
        2
    ]
    assert code == 0 and re.fullmatch(
        r"half of the pixels .* ± 0\.0\d+ stops, 95 % to ± 0\.\d+", words
    )
    E, s = read_layers(both).values()
    assert np.array_equal(E, radiance.read_radiance(both)) and E.shape == s.shape
    assert (
        np.allclose(E, radiance.read_radiance(out)) and 0 < np.median((s / E)[np.isfinite(s)]) < 0.1
    )
    about = hdrlab("info", both, capsys=capsys)[1]
    assert "layers" in about and "radiance, standard deviation" in about and words in about
    assert words in (page / "report.html").read_text(encoding="utf8").replace("\u00a0", " ")


def test_a_standard_deviation_wants_an_exr_file_and_says_so_before_the_work(
    photographs, tmp_path, capsys
):
    folder, times = photographs
    code, _, said = hdrlab(
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
    assert (
        code == 2 and said.count("\n") == 1 and ".exr" in said and not (tmp_path / "x.pfm").exists()
    )


def test_a_map_without_doubts_has_none_in_its_header_and_passes_strictly(
    photographs, tmp_path, capsys
):
    folder, times = photographs
    code, _, said = hdrlab(
        "assemble", folder, "-o", tmp_path / "x.hdr", "--times", times, "--strict", capsys=capsys
    )
    assert code == 0 and "warning" not in said
    assert b"doubt" not in (tmp_path / "x.hdr").read_bytes()[:500]


@pytest.mark.papers
def test_times_that_nobody_knows_are_steps_or_the_pixels(photographs, tmp_path, capsys):
    folder, _ = photographs
    steps, pixels = tmp_path / "steps.pfm", tmp_path / "pixels.pfm"
    code, _, said = hdrlab("assemble", folder, "-o", steps, "--stops", 2, capsys=capsys)
    assert code == 0 and "warning" not in said
    code, _, said = hdrlab("assemble", folder, "-o", pixels, "--times", "estimate", capsys=capsys)
    assert code == 0 and "relative exposure times" in said and "--stops" in said


def test_a_list_of_times_in_the_folder_is_found(photographs, tmp_path, capsys):
    folder, times = photographs
    (folder / "readme.txt").write_text("Photographs of a room")
    (folder / "times.txt").write_text(times.read_text())
    code, _, said = hdrlab("assemble", folder, "-o", tmp_path / "x.pfm", capsys=capsys)
    assert code == 0 and "note: the exposure times are those of" in said and "times.txt" in said


def test_folders_named_like_files_beside_the_photos_are_skipped(photographs, tmp_path, capsys):
    folder, times = photographs
    for name in ("a.csv", "old.txt", "copy.png", "x.jpg", "x.hdr", "y.dng"):
        (folder / name).mkdir()
    (folder / "b.txt").write_bytes(b"\xff\xfe")
    (folder / "times.csv").write_text(times.read_text())
    code, _, notes = hdrlab("assemble", folder, "-o", tmp_path / "x.pfm", capsys=capsys)
    assert code == 0
    assert "times.csv" in notes


@pytest.mark.papers
@pytest.mark.parametrize("form", ["{:g}", "{:g} s"])
@pytest.mark.parametrize("power", [1, -1])
def test_numbers_in_a_list_are_seconds_or_one_over_seconds_by_the_pixels(
    photographs, tmp_path, form, power
):
    folder, times = photographs
    exposures = [line.split(",") for line in times.read_text().splitlines()[1:]]
    rows = [f"{name} {form.format(float(t) ** power)}" for name, t in exposures]
    (tmp_path / "list.txt").write_text("\n".join(rows))
    wrong = power < 0 and " s" in form
    out = tmp_path / "x.pfm"
    assert hdrlab("assemble", folder, "-o", out, "--times", tmp_path / "list.txt") == (
        2 if wrong else 0
    )
    if not wrong:
        assert hdrlab("assemble", folder, "-o", tmp_path / "y.pfm", "--times", times) == 0
        assert np.allclose(
            radiance.read_radiance(out), radiance.read_radiance(tmp_path / "y.pfm"), rtol=1e-3
        )


def test_times_in_the_wrong_order_are_refused_with_a_way_on_that_works(
    photographs, tmp_path, capsys
):
    folder, times = photographs
    text = times.read_text().replace("0.01", "x").replace("0.64", "0.01").replace("x", "0.64")
    times.write_text(text)
    out = tmp_path / "x.hdr"
    code, _, said = hdrlab("assemble", folder, "-o", out, "--times", times, capsys=capsys)
    assert code == 2 and "longer exposure is the darker" in said and "--times estimate" in said
    assert not out.exists()
    assert hdrlab("assemble", folder, "-o", out, "--times", "estimate") == 0


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["assemble", "nowhere", "-o", "x.hdr"], "nowhere"),
        (["assemble", "nowhere", "-o", "x.bmp"], ".hdr"),
        (["tonemap", "nowhere.hdr", "-o", "x.png"], "nowhere.hdr"),
        (["convert", "nowhere.hdr", "x.exr"], "nowhere.hdr"),
        (["info", "nowhere.jpg"], "nowhere.jpg"),
        (["assemble", "nowhere", "-o", "x.hdr", "--mask", "blue"], "RRGGBB"),
        (["tonemap"], "Missing argument"),
        (["frobnicate"], "frobnicate"),
        (["assemble", "nowhere", "-o", "x.hdr", "--response", "magic"], "magic"),
    ],
)
def test_what_cannot_be_done_ends_in_one_line_and_exit_code_2(
    arguments, expected, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    code, said, complaint = hdrlab(*arguments, capsys=capsys)
    assert code == 2 and said == ""
    assert complaint.startswith("hdrlab: ") and complaint.count("\n") == 1 and expected in complaint
    assert list(tmp_path.iterdir()) == []


def test_the_settings_of_an_operator_are_set_by_name(map_file, tmp_path):
    dark, bright = tmp_path / "dark.png", tmp_path / "bright.png"
    assert hdrlab("tonemap", map_file, "-o", dark, "--set", "key=0.09") == 0
    assert hdrlab("tonemap", map_file, "-o", bright, "--set", "key=0.72") == 0
    assert read_photo(dark).mean() < read_photo(bright).mean() - 10


@pytest.mark.parametrize(
    ("setting", "expected"), [("kee=1", "key"), ("key", "NAME=VALUE"), ("key=bright", "key")]
)
def test_a_setting_that_the_operator_does_not_have_is_refused(
    setting, expected, map_file, tmp_path, capsys
):
    code, _, complaint = hdrlab(
        "tonemap", map_file, "-o", tmp_path / "x.png", "--set", setting, capsys=capsys
    )
    assert code == 2 and expected in complaint and not (tmp_path / "x.png").exists()


@pytest.mark.parametrize("suffix", [".pfm", ".exr"])
def test_convert_keeps_every_bit_of_a_float_map(suffix, map_file, tmp_path):
    assert hdrlab("convert", map_file, tmp_path / f"b{suffix}") == 0
    assert np.array_equal(
        radiance.read_radiance(tmp_path / f"b{suffix}"), radiance.read_radiance(map_file)
    )


def write_pfm(file, pixels):
    """Write a .pfm file of any values, (H, W, 3): `write_radiance` takes radiance alone."""
    file.write_bytes(
        b"PF\n%d %d\n-1.0\n" % (pixels.shape[1], pixels.shape[0]) + pixels.astype("<f4").tobytes()
    )


def test_values_that_are_no_radiance_are_repaired_with_a_note(tmp_path, capsys):
    file, out = tmp_path / "x.pfm", tmp_path / "x.png"
    pixels = np.ones((4, 5, 3))
    pixels[0, 0, 0], pixels[1, 1, 1], pixels[2, 2, 2], pixels[3, 3] = np.nan, np.inf, -0.1, -1
    write_pfm(file, pixels)
    counts = ("1 unknown", "1 infinite", "1 pixels with a negative channel", "1 pixels below black")
    for command in (["tonemap", file, "-o", out], ["convert", file, tmp_path / "y.exr"]):
        code, _, note = hdrlab(*command, capsys=capsys)
        assert code == 0
        assert note.startswith(f"note: {file}") and note.count("\n") == 1
        assert all(count in note for count in counts)
    assert out.exists() and np.isfinite(radiance.read_radiance(tmp_path / "y.exr")).all()
    assert hdrlab("convert", tmp_path / "y.exr", file, capsys=capsys)[2] == ""
    assert "nothing" in hdrlab("convert", tmp_path / "y.exr", file, "--clean", capsys=capsys)[1]


@pytest.mark.parametrize("value", [np.nan, np.inf, -1.0])
def test_a_map_that_is_mostly_no_radiance_is_refused_unless_it_is_to_be_cleaned(
    value, tmp_path, capsys
):
    file, out = tmp_path / "x.pfm", tmp_path / "out.pfm"
    pixels = np.ones((4, 5, 3))
    pixels[:2] = value
    write_pfm(file, pixels)
    code, _, complaint = hdrlab("convert", file, out, capsys=capsys)
    assert (
        code == 2 and str(file) in complaint and "20 pixels" in complaint and "--clean" in complaint
    )
    assert not out.exists() and hdrlab("convert", file, out, "--clean") == 0
    assert np.isfinite(radiance.read_radiance(out)).all()


def test_either_way_of_colour_can_be_asked_for(tmp_path, capsys):
    E = np.float32([0.1, 0.3, 4.0]) * np.geomspace(0.1, 30, 20 * 30).reshape(20, 30, 1).astype(
        np.float32
    )
    radiance.write_radiance(tmp_path / "blue.exr", E)
    pictures = {}
    for way in ("ratio", "hue"):
        out = tmp_path / f"{way}.png"
        assert hdrlab("tonemap", tmp_path / "blue.exr", "-o", out, "--way", way) == 0
        pictures[way] = read_photo(out).astype(int)
    brightest = {way: picture[-1, -1] for way, picture in pictures.items()}
    assert brightest["ratio"][2] == 255 > brightest["ratio"][0] + 20
    cyan = {way: levels[1] - levels[0] for way, levels in brightest.items()}
    assert cyan["hue"] < cyan["ratio"] / 2, "clipped, a blue turns"
    code, _, complaint = hdrlab(
        "tonemap", tmp_path / "blue.exr", "-o", tmp_path / "x.png", "--way", "lab", capsys=capsys
    )
    assert code == 2 and "'hue', 'ratio'" in complaint


def test_info_names_format_and_size(map_file, photographs, capsys):
    code, said, _ = hdrlab(
        "info", map_file, next(iter(sorted(photographs[0].iterdir()))), capsys=capsys
    )
    assert code == 0 and "OpenEXR" in said and "PNG" in said
    assert said.split()[said.split().index("width") + 1] == "64"


def test_a_failed_run_leaves_the_old_file_as_it_was(photographs, tmp_path):
    out = tmp_path / "room.hdr"
    out.write_bytes(b"precious")
    assert hdrlab("assemble", photographs[0], "-o", out) == 2
    assert out.read_bytes() == b"precious"


def test_ctrl_c_ends_in_one_line_and_exit_code_130(monkeypatch, tmp_path, capsys):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("hdrlab.io.album.select", interrupted)
    code, said, complaint = hdrlab("assemble", tmp_path, "-o", tmp_path / "x.hdr", capsys=capsys)
    assert (code, said, complaint.strip()) == (130, "", "hdrlab: interrupted")
    assert list(tmp_path.iterdir()) == []


def test_ctrl_c_while_a_class_is_made_ends_in_one_line_too(monkeypatch, tmp_path, capsys):
    class Stopped:
        def __set_name__(self, owner, name):
            raise KeyboardInterrupt

    monkeypatch.setattr(
        "hdrlab.io.album.select", lambda *_, **__: type("Axes", (), {"a": Stopped()})
    )
    code, said, complaint = hdrlab("assemble", tmp_path, "-o", tmp_path / "x.hdr", capsys=capsys)
    assert (code, said, complaint.strip()) == (130, "", "hdrlab: interrupted")


def test_ctrl_c_while_a_module_of_c_is_made_ends_in_one_line_too(monkeypatch, tmp_path, capsys):
    def stopped(*_, **__):  # as pybind11 tells it
        raise ImportError("initialization failed") from KeyboardInterrupt()

    monkeypatch.setattr("hdrlab.io.album.select", stopped)
    code, said, complaint = hdrlab("assemble", tmp_path, "-o", tmp_path / "x.hdr", capsys=capsys)
    assert (code, said, complaint.strip()) == (130, "", "hdrlab: interrupted")


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
def test_ctrl_c_while_the_command_is_loaded_ends_in_one_line_and_a_fault_does_not(
    raised, code, complaint
):
    ended = subprocess.run(
        [sys.executable, "-c", WHILE_LOADING.format(raised=raised), "info"],
        capture_output=True,
        text=True,
        encoding="utf8",
    )
    assert (ended.returncode, ended.stderr.splitlines()[-1]) == (code, complaint)
    assert code == 1 or len(ended.stderr.splitlines()) == 1


@pytest.mark.parametrize("kind", [ValueError, RuntimeError, ImportError, KeyError])
def test_a_bug_shows_its_traceback_and_is_not_taken_for_bad_input(
    kind, monkeypatch, tmp_path, capsys
):
    def broken(*_, **__):
        raise kind("a mistake of ours")

    monkeypatch.setattr("hdrlab.io.album.select", broken)
    code, _, complaint = hdrlab("assemble", tmp_path, "-o", tmp_path / "x.hdr", capsys=capsys)
    assert code == 1 and complaint.startswith("Traceback") and "a mistake of ours" in complaint
    closing_line = complaint.splitlines()[-1]
    assert closing_line.startswith("hdrlab: ") and "bug in hdrlab" in closing_line


def test_too_little_memory_is_one_line_with_advice(monkeypatch, tmp_path, capsys):
    def exhausted(*_, **__):
        raise MemoryError("Unable to allocate 9 GiB")

    monkeypatch.setattr("hdrlab.io.album.select", exhausted)
    code, _, complaint = hdrlab("assemble", tmp_path, "-o", tmp_path / "x.hdr", capsys=capsys)
    assert code == 2 and complaint.count("\n") == 1
    assert "smaller photos" in complaint and "9 GiB" in complaint


@pytest.mark.parametrize("words", ["--debug info missing.jpg", "info missing.jpg --debug"])
def test_debug_shows_the_traceback_of_bad_input_too(words, monkeypatch, tmp_path, capsys):
    monkeypatch.chdir(tmp_path)
    code, _, complaint = hdrlab(*words.split(), capsys=capsys)
    assert code == 2 and "Traceback" in complaint
    assert "missing.jpg" in complaint.splitlines()[-1]


def test_lab_copies_notebooks_and_assignments_and_keeps_what_the_reader_changed(tmp_path, capsys):
    copy = tmp_path / "mine"
    assert hdrlab("lab", "--folder", copy, "--copy-only") == 0
    mine = [copy / "notebooks/04_response_gsolve.ipynb", copy / "assignments/hw2.ipynb"]
    for notebook in mine:
        notebook.write_text("mine")
    code, said, _ = hdrlab("lab", "--folder", copy, "--copy-only", capsys=capsys)
    assert code == 0 and "0 new" in said
    assert [notebook.read_text() for notebook in mine] == ["mine", "mine"]


@pytest.mark.papers
def test_lab_opens_the_first_notebook_of_the_copy(tmp_path, monkeypatch):
    called = []
    monkeypatch.setenv("JUPYTER_CONFIG_PATH", "")  # which the command sets
    monkeypatch.setattr("jupyterlab.labapp.LabApp.launch_instance", called.append)
    assert hdrlab("lab", "--folder", tmp_path / "mine", "--", "--port", "9000") == 0
    first = next(part for part in called[0] if part.startswith("--LabApp.default_url="))
    assert (tmp_path / "mine" / first.removeprefix("--LabApp.default_url=/lab/tree/")).is_file()
    assert called[0][-2:] == ["--port", "9000"]


def test_lab_saves_what_the_widgets_show_and_keeps_news_away(tmp_path, monkeypatch):
    server = pytest.importorskip("jupyterlab_server.config")
    monkeypatch.setenv("JUPYTER_CONFIG_PATH", str(tmp_path / "own"))
    monkeypatch.setattr("jupyterlab.labapp.LabApp.launch_instance", lambda options: None)
    assert hdrlab("lab", "--folder", tmp_path / "mine") == 0
    found = server.ConfigManager(config_dir_name="labconfig").get("default_setting_overrides")
    assert found["@jupyter-widgets/jupyterlab-manager:plugin"] == {"saveState": True}
    assert found["@jupyterlab/apputils-extension:notification"]["fetchNews"] == "false"
    assert os.environ["JUPYTER_CONFIG_PATH"].endswith(os.pathsep + str(tmp_path / "own"))


def test_an_agreement_that_cannot_be_measured_is_no_number_of_stops():
    assert "0.012 stops" in describe_agreement(0.0123)
    assert not re.search(r"\d|nan|stops", describe_agreement(float("nan")))


def test_one_reading_of_a_meter_makes_the_map_absolute(photographs, tmp_path, capsys):
    folder, times = photographs
    arguments = ["assemble", folder, "--times", times, "--align", "none", "-o", tmp_path / "a.exr"]
    code, _, said = hdrlab(*arguments, "--calibrate", "20,30=50", capsys=capsys)
    L, truth = (
        luminance(radiance.read_radiance(tmp_path / "a.exr")),
        luminance(scenes.room((96, 144))),
    )
    assert code == 0 and "50 cd/m^2 at 20,30" in said
    assert np.isclose(L[29:32, 19:22].mean(), 50, rtol=1e-3)
    assert np.isclose(np.median(L / truth), 50 / truth[29:32, 19:22].mean(), rtol=0.15)


@pytest.mark.parametrize(
    ("reading", "expected"),
    [("20;30=50", "expected X,Y=CD"), ("900,3=50", "144 x 96"), ("20,30=0", "got 0 at")],
)
def test_a_reading_that_cannot_be_writes_nothing(photographs, tmp_path, capsys, reading, expected):
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
    code, _, said = hdrlab(*arguments, capsys=capsys)
    assert code == 2 and expected in said and not (tmp_path / "a.exr").exists()
