"""Radiance files by their suffix, and the metadata of all kinds of files."""

import numpy as np
import pytest

from hdrlab.io.maps import exr, pfm
from hdrlab.io.photos import write_picture
from hdrlab.io.radiance import (
    SUFFIXES,
    read_luminance_of_unit,
    read_radiance,
    write_radiance,
)
from hdrlab.show.describe import describe_file

# RGBE keeps one power
E = np.exp2(np.random.default_rng(0).integers(-20, 20, (7, 9, 3))).astype(np.float32)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_every_format_survives_a_round_trip(tmp_path, suffix):
    gray = E[..., 0].copy()
    write_radiance(tmp_path / f"x{suffix}", gray)
    read = read_radiance(tmp_path / f"x{suffix}")
    assert read.dtype == np.float32
    assert np.array_equal(read if read.ndim == 2 else read[..., 1], gray)


@pytest.mark.parametrize("suffix", sorted(set(SUFFIXES) - {".pfm"}))
@pytest.mark.parametrize("unit", [0.012345, 1.0, 3e7])
def test_luminance_of_a_unit_survives_a_round_trip(tmp_path, suffix, unit):
    path = tmp_path / f"x{suffix}"
    write_radiance(path, E, comments=["warning: a cloud came"], luminance_of_unit=unit)
    assert read_luminance_of_unit(path) == pytest.approx(unit, rel=1e-5)
    assert "warning: a cloud came" in str(describe_file(path))
    write_radiance(path, E, comments=["a cloud came"])
    assert read_luminance_of_unit(path) is None


def test_pfm_has_no_place_for_the_luminance_of_a_unit(tmp_path):
    write_radiance(tmp_path / "x.pfm", E, luminance_of_unit=2.0)
    assert read_luminance_of_unit(tmp_path / "x.pfm") is None
    assert np.array_equal(read_radiance(tmp_path / "x.pfm"), E)


def test_openexr_states_it_by_the_standard_attribute(tmp_path):
    write_radiance(tmp_path / "x.exr", E, luminance_of_unit=2.5)
    assert exr.read_header(tmp_path / "x.exr").attributes["whiteLuminance"] == 2.5


@pytest.mark.parametrize("stated", ["0 cd/m^2", "-3 cd/m^2", "1e999 cd/m^2", "1-1 cd/m^2", "nits"])
def test_a_unit_that_is_no_positive_number_is_ignored(tmp_path, stated):
    write_radiance(tmp_path / "x.hdr", E, comments=[f"unit: {stated}"])
    assert read_luminance_of_unit(tmp_path / "x.hdr") is None


def test_suffixes_may_be_uppercase(tmp_path):
    write_radiance(tmp_path / "x.EXR", E)
    assert np.array_equal(read_radiance(tmp_path / "x.EXR"), E)


@pytest.mark.parametrize("name", ["x.png", "x", "x.hdr.gz"])
def test_other_suffixes_are_rejected_by_name(tmp_path, name):
    for act in read_radiance, lambda path: write_radiance(path, E):
        with pytest.raises(ValueError, match=f"{name}: .*radiance file .*.hdr"):
            act(tmp_path / name)


def test_half_floats_are_rejected_for_other_formats_than_exr(tmp_path):
    write_radiance(tmp_path / "x.exr", np.ones((2, 2)), half=True)
    assert exr.read_dtypes(tmp_path / "x.exr") == ("float16",)
    with pytest.raises(ValueError, match="x.hdr: .*.exr file for half floats"):
        write_radiance(tmp_path / "x.hdr", E, half=True)


def spoiled(path):
    """Write a PFM file with values that are not radiance."""
    values = np.array([[np.nan, np.inf, -np.inf, -1, 0, 7]], "<f4")
    path.write_bytes(b"Pf\n6 1\n-1.0\n" + values.tobytes())
    return path


def test_invalid_values_are_rejected_with_their_counts(tmp_path):
    with pytest.raises(
        ValueError, match=r"x.pfm: .*got 1 NaN, 2 infinite and 2 negative values.*clean=True"
    ):
        read_radiance(spoiled(tmp_path / "x.pfm"))


def test_cleaning_repairs_nan_infinity_and_negative_values(
    tmp_path,
):
    path = spoiled(tmp_path / "x.pfm")
    # at -inf: the mean of 7 and -1
    assert np.allclose(read_radiance(path, clean=True), [[7, 7, 3, 0, 0, 7]])
    assert np.isnan(pfm.read(path)[0, 0])


def test_cleaning_does_not_change_valid_radiance(tmp_path):
    write_radiance(tmp_path / "x.exr", E)
    assert np.array_equal(read_radiance(tmp_path / "x.exr", clean=True), E)


@pytest.mark.parametrize("suffix", [".hdr", ".pfm", ".exr", ".png"])
def test_missing_file_or_folder_raises_file_not_found_error(tmp_path, suffix):
    with pytest.raises(FileNotFoundError):
        describe_file(tmp_path / f"x{suffix}")
    if suffix in SUFFIXES:
        with pytest.raises(FileNotFoundError):
            read_radiance(tmp_path / f"x{suffix}")
        with pytest.raises(FileNotFoundError, match="no folder"):
            write_radiance(tmp_path / "nowhere" / f"x{suffix}", E)


@pytest.mark.parametrize(
    ("suffix", "says"),
    [
        (".hdr", {"format": "Radiance RGBE", "channels": 3, "axes": "-Y+X", "exposure": [1, 1, 1]}),
        (
            ".pfm",
            {"format": "PFM", "channels": 3, "values": "float32", "endian": "little", "scale": 1},
        ),
        (
            ".exr",
            {"format": "OpenEXR", "channels": "B, G, R", "values": "float32", "compression": "ZIP"},
        ),
        (".png", {"format": "PNG", "channels": 3, "values": "uint8", "orientation": 1}),
        (".jpg", {"format": "JPEG", "channels": 3, "values": "uint8", "orientation": 1}),
        (".tif", {"format": "TIFF", "channels": 3, "values": "uint8", "orientation": 1}),
        (".tiff", {"format": "TIFF", "channels": 3, "values": "float32"}),
    ],
)
def test_describe_file_states_format_size_and_values(tmp_path, suffix, says):
    path = tmp_path / f"x{suffix}"
    if "orientation" in says:
        write_picture(path, E.astype(np.uint8))
    else:
        write_radiance(path, E)
    description = describe_file(path)
    assert description["file"] == str(path)
    assert (description["width"], description["height"]) == (
        9,
        7,
    )
    assert {key: description[key] for key in says} == says


def test_describe_file_states_the_exposure_of_a_photo(shared):
    description = describe_file(shared("frobisher") / "IMG_2600.jpg")
    assert (description["seconds"], description["f_number"], description["iso"]) == (0.125, 8, 100)
