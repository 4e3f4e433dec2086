"""Floating-point TIFF, against OpenCV's reader and writer."""

import cv2
import imagecodecs
import numpy as np
import pytest
import tifffile

from hdrlab.core import gamut
from hdrlab.errors import FileFormatError, InputError
from hdrlab.io.maps import tiff
from hdrlab.io.photos import write_picture
from hdrlab.io.radiance import read_radiance, write_radiance
from hdrlab.show.describe import describe_file

RNG = np.random.default_rng(0)
RGB = np.exp(4 * RNG.standard_normal((13, 17, 3))).astype(np.float32)
GRAY = RGB[..., 0].copy()
in_color_and_gray = pytest.mark.parametrize("E", [RGB, GRAY], ids=["RGB", "gray"])


@in_color_and_gray
def test_tiff_maps_can_be_exchanged_with_opencv_bit_for_bit(tmp_path, E):
    ours = tmp_path / "ours.tif"
    theirs = tmp_path / "theirs.tiff"
    write_radiance(ours, E)
    read_by_opencv = cv2.imread(str(ours), cv2.IMREAD_UNCHANGED)
    assert read_by_opencv.dtype == np.float32
    assert np.array_equal(read_by_opencv if E.ndim == 2 else read_by_opencv[..., ::-1], E)
    bgr = E if E.ndim == 2 else np.ascontiguousarray(E[..., ::-1])
    # uncompressed: by itself, OpenCV before 4.11 writes colours as LogLuv, which loses
    assert cv2.imwrite(str(theirs), bgr, [cv2.IMWRITE_TIFF_COMPRESSION, 1])
    read = read_radiance(theirs)
    assert read.dtype == np.float32 and np.array_equal(read, E)


@in_color_and_gray
@pytest.mark.parametrize("dtype", ["<f2", ">f4", "<f8"])
@pytest.mark.parametrize(
    "form", [{}, {"compression": "zlib", "predictor": True}, {"tile": (16, 16)}], ids=str
)
def test_other_float_sizes_byte_orders_tiles_and_compression_are_read(tmp_path, E, dtype, form):
    E = np.minimum(E, 60_000)
    kind = "rgb" if E.ndim == 3 else "minisblack"
    order = ">" if dtype[0] == ">" else "<"
    tifffile.imwrite(tmp_path / "a.tif", E.astype(dtype), photometric=kind, byteorder=order, **form)
    assert np.allclose(
        tiff.read(tmp_path / "a.tif"), E, rtol=1e-3 if dtype == "<f2" else 1e-7, atol=1e-7
    )


@pytest.mark.parametrize("planar", ["contig", "separate"])
def test_alpha_is_dropped_and_separate_planes_are_joined(tmp_path, planar):
    pixels = np.dstack([RGB, np.full(GRAY.shape, 0.5, np.float32)])
    pixels = pixels if planar == "contig" else np.moveaxis(pixels, -1, 0)
    tifffile.imwrite(
        tmp_path / "a.tif",
        pixels,
        photometric="rgb",
        planarconfig=planar,
        extrasamples=["unassalpha"],
    )
    assert np.array_equal(tiff.read(tmp_path / "a.tif"), RGB)


def test_integer_tiff_is_rejected_as_a_map_and_info_describes_both(tmp_path):
    photo = tmp_path / "photo.tif"
    radiance = tmp_path / "map.tif"
    write_picture(photo, np.zeros((4, 5, 3), np.uint8))
    with pytest.raises(ValueError, match=r"photo.tif: .*floating-point samples.*3 x uint8"):
        read_radiance(photo)
    write_radiance(radiance, RGB, comments=["two frames of seven", "unit: cd/m²"])
    assert describe_file(photo)["values"] == "uint8"
    about = describe_file(radiance)
    assert about["values"] == "float32"
    assert about["comments"] == [
        "two frames of seven",
        "unit: cd/m²",
    ]


@pytest.mark.parametrize("kept", [0.3, 0.9])
def test_truncated_tiff_is_rejected(tmp_path, kept):
    write_radiance(tmp_path / "a.tif", RGB)
    data = (tmp_path / "a.tif").read_bytes()
    (tmp_path / "b.tif").write_bytes(data[: int(kept * len(data))])
    with pytest.raises(ValueError, match=r"b.tif: .*damaged"):
        read_radiance(tmp_path / "b.tif")


def test_doubles_beyond_float32_are_rejected_as_infinite(tmp_path):
    tifffile.imwrite(tmp_path / "a.tif", np.array([[1e300, 1.0]]), photometric="minisblack")
    with pytest.raises(ValueError, match=r"a.tif: .*1 infinite"):
        read_radiance(tmp_path / "a.tif")


def profile(primaries, **curve):
    """Return a profile of these primaries, with the given gamma or table as its curve."""
    xy = np.array(primaries).reshape(4, 2)
    xyY = np.column_stack([xy[:3], np.ones(3)])
    white = (*xy[3], 1)
    return imagecodecs.cms_profile("rgb", whitepoint=white, primaries=xyY.ravel(), **curve)


def test_primaries_of_a_linear_profile_are_converted_to_srgb(tmp_path):
    """By the matrix of ITU-R BT.2087, annex 2, from BT.2020 to BT.709."""
    E = np.full((4, 5, 3), [2.0, 1.5, 1.0], np.float32)
    path = tmp_path / "wide.tif"
    icc = profile(gamut.WIDE["bt2020"], gamma=1.0)
    tifffile.imwrite(path, E, photometric="rgb", iccprofile=icc)
    to_bt709 = [[1.6605, -0.5876, -0.0728], [-0.1246, 1.1329, -0.0083], [-0.0182, -0.1006, 1.1187]]
    expected = np.array(to_bt709) @ E[0, 0]
    assert read_radiance(path)[1, 2] == pytest.approx(expected, rel=2e-3)


def test_linear_profile_of_srgb_changes_nothing(tmp_path):
    path = tmp_path / "srgb.tif"
    tifffile.imwrite(path, RGB, photometric="rgb", iccprofile=profile(gamut.SRGB, gamma=1.0))
    assert np.array_equal(read_radiance(path), RGB)


@pytest.mark.parametrize("primaries", [gamut.SRGB, gamut.WIDE["p3"]], ids=["sRGB", "P3"])
def test_floats_that_a_profile_calls_coded_are_rejected(tmp_path, primaries):
    path = tmp_path / "coded.tif"
    tifffile.imwrite(path, RGB, photometric="rgb", iccprofile=profile(primaries, gamma=2.2))
    with pytest.raises(FileFormatError, match=r"coded\.tif.*linear"):
        read_radiance(path)


def test_damaged_profile_of_a_map_is_rejected_by_name(tmp_path):
    path = tmp_path / "broken.tif"
    tifffile.imwrite(path, RGB, photometric="rgb", iccprofile=b"no profile at all")
    with pytest.raises(InputError, match=r"broken\.tif"):
        read_radiance(path)
