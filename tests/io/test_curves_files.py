"""Files of response curves: round trips, also through the programs whose formats they are."""

import re
import shutil
import subprocess

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings, strategies as st

from hdrlab import scenes
from hdrlab.capture import camera
from hdrlab.errors import InputError
from hdrlab.io.maps import pfm
from hdrlab.io.photos import write_picture
from hdrlab.io.response_files import FORMS, read_curve, suffix_of, write_curve

Z = np.arange(256)
GRAY = np.log(np.maximum(Z, 0.25) / 128)
RGB = GRAY[:, None] * [1.8, 2.0, 2.2]
EXACT = {".csv": 0, ".m": 1e-8}


@pytest.fixture(scope="module")
def bracket(tmp_path_factory):
    """Return a folder of four photographs, frame0.jpg to frame3.jpg, and their list for pfsinhdrgen."""
    folder = tmp_path_factory.mktemp("bracket")
    taken = camera.shoot(
        scenes.room((96, 144)), [0.01, 0.04, 0.16, 0.64], camera.Camera(sensitivity=0.05), rng=1
    )
    lines = []
    for j, (image, seconds) in enumerate(zip(taken.images, taken.times, strict=True)):
        write_picture(folder / f"frame{j}.jpg", image)
        lines.append(f"{folder}/frame{j}.jpg {1 / seconds} 8 100 0\n")
    (folder / "list.hdrgen").write_text("".join(lines))
    return folder


@pytest.mark.parametrize("suffix", FORMS)
def test_curves_survive_a_round_trip(suffix, tmp_path):
    write_curve(tmp_path / f"g{suffix}", RGB)
    f = np.exp(read_curve(tmp_path / f"g{suffix}"))
    g = np.exp(RGB)
    assert f.shape == g.shape and np.allclose(f, g, rtol=EXACT[suffix], atol=1e-9)


def test_csv_keeps_every_bit(tmp_path):
    g = RGB + np.random.default_rng(1).normal(0, 1e-3, RGB.shape)
    g -= g[128]
    write_curve(tmp_path / "g.csv", g)
    assert np.array_equal(read_curve(tmp_path / "g.csv"), g)


@pytest.mark.papers
@pytest.mark.parametrize("suffix", [".csv", ".m"])
@pytest.mark.parametrize("n", [256, 65536])
def test_gray_curves_and_16_bits_keep_their_shape(suffix, n, tmp_path):
    g = np.log(np.maximum(np.arange(n), 0.25) / (n // 2))
    write_curve(tmp_path / f"g{suffix}", g)
    assert np.allclose(read_curve(tmp_path / f"g{suffix}"), g, atol=1e-8)


def test_csv_has_a_header_with_units_and_a_line_for_each_pixel_value(tmp_path):
    write_curve(tmp_path / "g.csv", RGB)
    lines = (tmp_path / "g.csv").read_text().splitlines()
    assert lines[0] == "level,red (ln exposure),green (ln exposure),blue (ln exposure)"
    assert lines[129] == "128,0.0,0.0,0.0" and len(lines) == 257


def test_read_curve_shifts_curves_to_0_at_the_middle_pixel_value(tmp_path):
    write_curve(tmp_path / "g.m", RGB + [1.0, -2.0, 3.0])
    assert np.allclose(read_curve(tmp_path / "g.m"), RGB, atol=1e-8)


def test_pixel_values_without_exposure_are_interpolated(tmp_path):
    """If a calibration has no result for a pixel value, pfstools writes 0, and -6 as its logarithm."""
    write_curve(tmp_path / "g.m", GRAY)
    lines = (tmp_path / "g.m").read_text().splitlines()
    for z in (0, 1, 100, 255):
        lines[6 + z] = f" -6.0 {z} 0.0"
    (tmp_path / "g.m").write_text("\n".join([*lines, ""]))
    g = read_curve(tmp_path / "g.m")
    assert g[0] == g[1] == g[2] and g[255] == g[254]
    assert np.isclose(g[100], (GRAY[99] + GRAY[101]) / 2, atol=1e-6)


@pytest.mark.parametrize(
    ("g", "expected"),
    [
        (np.zeros((256, 2)), "(n, 3)"),
        (np.zeros(100), "256 or 65536"),
        (np.full(256, np.nan), "-80 to 80"),
        (np.full(256, 800.0), "-80 to 80"),
        (np.array(["a"] * 256), "expected a response"),
    ],
)
@pytest.mark.parametrize("suffix", FORMS)
def test_write_curve_rejects_invalid_responses(suffix, g, expected, tmp_path):
    (tmp_path / f"g{suffix}").write_text("precious")
    with pytest.raises(ValueError, match=re.escape(expected)):
        write_curve(tmp_path / f"g{suffix}", g)
    assert (tmp_path / f"g{suffix}").read_text() == "precious"
    assert [file.name for file in tmp_path.iterdir()] == [f"g{suffix}"]


def test_suffix_selects_the_format():
    assert suffix_of("a/room.old.CSV") == ".csv" and suffix_of("room.m") == ".m"
    for wrong in ("room.txt", "room", "folder.csv/room"):
        with pytest.raises(ValueError, match=".csv, .m"):
            suffix_of(wrong)


@pytest.mark.parametrize("suffix", FORMS)
def test_truncated_curves_are_rejected(suffix, tmp_path):
    path = tmp_path / f"g{suffix}"
    write_curve(path, RGB)
    data = path.read_bytes()
    # the weights are not read
    end = data.index(b"# Weighting") - 2 if suffix == ".m" else len(data) - 1
    for length in [0, 1, 30, *np.linspace(100, end, 12).astype(int), *range(end - 20, end + 1)]:
        path.write_bytes(data[:length])
        with pytest.raises(ValueError, match=re.escape(str(path))):
            read_curve(path)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    folder = tmp_path_factory.mktemp("whole")
    for suffix in FORMS:
        write_curve(folder / f"g{suffix}", RGB)
    return folder


places = st.one_of(st.integers(0, 300), st.integers(0, 30_000))
values = st.one_of(st.sampled_from(b"\n\r ,.-e019#\x00\xff"), st.integers(0, 255))


@pytest.mark.parametrize("suffix", FORMS)
@given(
    changes=st.lists(st.tuples(places, values), max_size=6),
    length=st.one_of(st.none(), places),
    inserted=st.tuples(places, st.binary(max_size=8)),
)
@settings(
    max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_damaged_curve_is_read_as_a_valid_response_or_rejected(
    whole, suffix, changes, length, inserted
):
    data = bytearray((whole / f"g{suffix}").read_bytes())
    for place, value in changes:
        data[place % len(data)] = value
    at, more = inserted
    data[at % len(data) : at % len(data)] = more
    path = whole / f"damaged{suffix}"
    path.write_bytes(data[:length])
    try:
        g = read_curve(path)
    except ValueError:
        return
    assert g.shape in ((256,), (256, 3)) and np.isfinite(g).all()


def test_curve_files_that_are_too_large_are_rejected(tmp_path):
    with open(tmp_path / "g.csv", "wb") as file:
        file.truncate(1 << 30)
    with pytest.raises(ValueError, match="bytes"):
        read_curve(tmp_path / "g.csv")


@pytest.mark.parametrize(
    "text", ["level,red\n", "a,b,c\n", "", "level,gray (ln exposure)\n0,1\n2,3\n"]
)
def test_other_tables_are_rejected_as_curves(text, tmp_path):
    (tmp_path / "g.csv").write_text(text)
    with pytest.raises(InputError):
        read_curve(tmp_path / "g.csv")


def pfstools(bracket, *options):
    """Run pfshdrcalibrate on the bracket and return its map; skip the test if it is not installed."""
    for program in ("pfsinhdrgen", "pfshdrcalibrate", "pfsout"):
        if not shutil.which(program):
            pytest.skip(f"{program} is not installed")
    out = bracket / "theirs.pfm"
    steps = (
        f"pfsinhdrgen list.hdrgen | pfshdrcalibrate {' '.join(map(str, options))} | pfsout {out}"
    )
    done = subprocess.run(
        ["bash", "-o", "pipefail", "-c", steps], cwd=bracket, capture_output=True, timeout=600
    )
    assert done.returncode == 0, done.stderr.decode()
    return pfm.read(out)


def test_curves_can_be_exchanged_with_pfstools(bracket, tmp_path):
    """With hdrlab's copy of pfstools' curve, both maps are equal up to a factor per channel."""
    theirs = pfstools(bracket, "-s", tmp_path / "theirs.m")
    g = read_curve(tmp_path / "theirs.m")
    assert g.shape == (256, 3) and np.all(g[200] > g[50])
    write_curve(tmp_path / "ours.m", g)
    ratio = pfstools(bracket, "-f", tmp_path / "ours.m") / theirs
    assert np.ptp(ratio.reshape(-1, 3), axis=0).max() < 1e-4
    # another curve, another map
    assert np.ptp(np.log(pfstools(bracket, "-r", "gamma") / theirs)) > 0.1
