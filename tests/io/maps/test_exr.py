"""OpenEXR files, compared with the official module, which also writes the unusual ones."""

import numpy as np
import OpenEXR
import pytest

from hdrlab.errors import FileFormatError
from hdrlab.io.maps import exr
from hdrlab.io.maps.layers import read_layers
from hdrlab.io.radiance import read_radiance

RGB = np.exp2(np.random.default_rng(0).uniform(-20, 15, (37, 21, 3))).astype(np.float32)
GRAY = RGB[..., 0].copy()


def wrote(path, channels, **header):
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, **header}
    with OpenEXR.File(header, channels) as file:
        file.write(str(path))
    return path


def window(left, top, right, bottom):
    return np.array([left, top], np.int32), np.array([right, bottom], np.int32)


@pytest.mark.parametrize(("E", "name"), [(RGB, "RGB"), (GRAY, "Y")])
def test_exr_files_can_be_exchanged_with_openexr_bit_for_bit(tmp_path, E, name):
    exr.write(tmp_path / "ours.exr", E)
    with OpenEXR.File(str(tmp_path / "ours.exr")) as file:
        theirs = file.channels()[name].pixels
        assert theirs.dtype == np.float32 and np.array_equal(theirs, E)
    assert np.array_equal(exr.read(tmp_path / "ours.exr"), E)
    assert np.array_equal(exr.read(wrote(tmp_path / "theirs.exr", {name: E})), E)


@pytest.mark.parametrize("dtype", [np.float16, np.float32, np.uint32])
@pytest.mark.parametrize("name", ["RGB", "Y", "Z"])
def test_half_float_and_unsigned_channels_become_float32(tmp_path, dtype, name):
    values = np.arange(24).astype(dtype).reshape((2, 4, 3) if name == "RGB" else (4, 6))
    E = exr.read(wrote(tmp_path / "x.exr", {name: values}))
    assert E.dtype == np.float32 and np.array_equal(E, values)
    assert set(exr.read_dtypes(tmp_path / "x.exr")) == {np.dtype(dtype).name}


def test_alpha_channel_is_dropped(tmp_path):
    RGBA = np.concatenate([RGB, np.full_like(RGB[..., :1], 0.5)], axis=-1)
    assert np.array_equal(exr.read(wrote(tmp_path / "a.exr", {"RGBA": RGBA})), RGB)
    assert np.array_equal(
        exr.read(wrote(tmp_path / "b.exr", {"Y": GRAY, "A": RGBA[..., 3].copy()})), GRAY
    )


COMPRESSIONS = ["NO", "RLE", "ZIPS", "ZIP", "PIZ"]


@pytest.mark.parametrize("compression", COMPRESSIONS)
@pytest.mark.parametrize("separate", [True, False])
def test_all_lossless_compressions_are_read(tmp_path, compression, separate):
    channels = {c: RGB[..., k].copy() for k, c in enumerate("RGB")} if separate else {"RGB": RGB}
    path = wrote(
        tmp_path / "x.exr", channels, compression=getattr(OpenEXR, f"{compression}_COMPRESSION")
    )
    assert np.array_equal(exr.read(path), RGB)


@pytest.mark.parametrize("offset", [(0, 0), (3, -2), (-5, 4)])
def test_smaller_data_window_is_padded_with_zeros(tmp_path, offset):
    x, y = offset
    header = {
        "dataWindow": window(10 + x, 20 + y, 13 + x, 22 + y),
        "displayWindow": window(x, y, 39 + x, 29 + y),
    }
    inside = RGB[:3, :4].copy()
    E = exr.read(wrote(tmp_path / "x.exr", {"RGB": inside}, **header))
    expected = np.zeros((30, 40, 3), np.float32)
    expected[20:23, 10:14] = inside
    assert np.array_equal(E, expected)


def test_larger_data_window_is_cropped(tmp_path):
    header = {"dataWindow": window(-2, -3, 18, 33), "displayWindow": window(0, 0, 9, 39)}
    E = exr.read(wrote(tmp_path / "x.exr", {"RGB": RGB}, **header))
    assert np.array_equal(E[:34], RGB[3:, 2:12]) and not E[34:].any() and E.shape == (40, 10, 3)


def test_data_window_outside_of_the_display_window_is_rejected(tmp_path):
    header = {"dataWindow": window(50, 0, 70, 36), "displayWindow": window(0, 0, 9, 9)}
    with pytest.raises(ValueError, match="x.exr: .*pixels in its display window"):
        exr.read(wrote(tmp_path / "x.exr", {"RGB": RGB}, **header))


def test_half_floats_keep_three_digits_and_reject_larger_values(tmp_path):
    path = tmp_path / "x.exr"
    exr.write(path, RGB, half=True)
    assert np.array_equal(exr.read(path), RGB.astype(np.float16))
    exr.write(path, [[65504.0]], half=True)
    with pytest.raises(ValueError, match="radiance up to 65504 for half floats.*65505"):
        exr.write(path, [[1.0, 65505.0]], half=True)
    assert exr.read(path) == 65504


def test_write_rejects_invalid_radiance(tmp_path):
    for value, says in (np.nan, "1 NaN"), (np.inf, "1 infinite"), (-1, "1 negative"):
        with pytest.raises(ValueError, match=says):
            exr.write(tmp_path / "x.exr", [[1.0, value]])
    assert not list(tmp_path.iterdir())


def test_other_channels_are_rejected_by_name(tmp_path):
    path = wrote(tmp_path / "x.exr", {"U": GRAY, "V": GRAY})
    with pytest.raises(ValueError, match="x.exr: .*channels R, G, B or Y.*U, V"):
        exr.read(path)


def test_subsampled_channels_are_rejected_by_name(tmp_path):
    path = wrote(tmp_path / "x.exr", {"Y": GRAY[:36, :20].copy()})
    data = bytearray(path.read_bytes())
    at = data.index(b"chlist\0") + len(b"chlist\0") + 4 + len(b"Y\0") + 8
    assert data[at : at + 8] == np.array([1, 1], "<i4").tobytes()
    data[at : at + 8] = np.array([2, 2], "<i4").tobytes()
    path.write_bytes(data)
    with pytest.raises(ValueError, match="x.exr: .*channels of full size.*subsampled"):
        exr.read(path)


@pytest.mark.parametrize("data", [b"", b"v/1\x01", b"\x89PNG\r\n\x1a\n", b"v/1\x01" + bytes(100)])
def test_other_files_are_rejected_as_exr_by_name(tmp_path, data):
    (tmp_path / "x.exr").write_bytes(data)
    with pytest.raises(ValueError, match="x.exr: .*OpenEXR file"):
        exr.read(tmp_path / "x.exr")


def test_missing_exr_raises_file_not_found_error(tmp_path):
    with pytest.raises(FileNotFoundError):
        exr.read(tmp_path / "x.exr")


def test_truncated_exr_is_rejected_and_nothing_is_printed(tmp_path, capsys):
    exr.write(tmp_path / "x.exr", RGB)
    data = (tmp_path / "x.exr").read_bytes()
    for length in range(len(data) - 1, 8, -397):
        (tmp_path / "x.exr").write_bytes(data[:length])
        with pytest.raises(ValueError, match="x.exr: .*OpenEXR file is cut short or damaged"):
            exr.read(tmp_path / "x.exr")
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize("name", [b"dataWindow", b"displayWindow"])
def test_header_with_an_absurd_size_allocates_no_memory(tmp_path, name):
    exr.write(tmp_path / "x.exr", RGB)
    data = bytearray((tmp_path / "x.exr").read_bytes())
    at = data.index(name + b"\0box2i\0") + len(name) + 7 + 4
    data[at : at + 16] = np.array([0, 0, 65535, 32767], "<i4").tobytes()
    (tmp_path / "x.exr").write_bytes(data)
    with pytest.raises(
        ValueError, match="x.exr: (its header claims 65536 x 32768 pixels| .*OpenEXR file)"
    ):
        exr.read(tmp_path / "x.exr")


REAL = ["BrightRings", "Carrots", "Desk", "GammaChart", "SquaresSwirls", "StillLife"]


@pytest.mark.parametrize("name", REAL)
def test_real_exr_files_equal_those_of_the_official_module(shared, name):
    path = shared("openexr") / f"{name}.exr"
    with OpenEXR.File(str(path), separate_channels=True) as file:
        theirs = np.stack([file.channels()[c].pixels for c in "RGB"], axis=-1)
    E = exr.read(path)
    assert E.dtype == np.float32 and np.array_equal(E, theirs)


def test_real_exr_with_nan_and_infinity_is_rejected_unless_cleaned(shared):
    path = shared("openexr") / "BrightRingsNanInf.exr"
    E = exr.read(path)
    nan = np.count_nonzero(np.isnan(E))
    inf = np.count_nonzero(np.isinf(E))
    assert nan + inf > 0
    with pytest.raises(
        ValueError, match=rf"BrightRingsNanInf.exr: .*got {nan} NaN, {inf} infinite.*clean=True"
    ):
        read_radiance(path)
    mended = read_radiance(path, clean=True)
    good = np.isfinite(E)
    assert np.array_equal(mended[good], np.maximum(E[good], 0)) and np.all(np.isfinite(mended))


TYPES = {"R": np.float16, "G": np.float32, "B": np.float16, "A": np.float16, "Z": np.float32}


def channels_of(names, types=TYPES):
    rng = np.random.default_rng(5)
    return {name: rng.random((5, 7)).astype(types.get(name, np.float32)) for name in names}


@pytest.mark.parametrize(
    "names",
    [
        ["R", "G", "B"],
        ["R", "G", "B", "A"],
        ["R", "G", "B", "Z"],
        ["R", "G", "B", "A", "Z"],
        ["R", "G", "B", "Y"],
        ["R", "G", "B", "left.R", "left.G", "left.B", "normal.X"],
    ],
    ids=" ".join,
)
@pytest.mark.parametrize("types", [TYPES, {}], ids=["mixed", "float"])
def test_color_is_read_bit_for_bit_from_mixed_types_and_among_other_channels(
    tmp_path, names, types
):
    channels = channels_of(names, types)
    path = wrote(tmp_path / "x.exr", {name: plane.copy() for name, plane in channels.items()})
    E = exr.read(path)
    for k, name in enumerate("RGB"):
        assert np.array_equal(E[..., k], channels[name].astype(np.float32))


@pytest.mark.parametrize("names", [["Y", "Z"], ["Y", "A", "Z"]])
def test_luminance_is_read_among_other_channels(tmp_path, names):
    channels = channels_of(names)
    path = wrote(tmp_path / "x.exr", {name: plane.copy() for name, plane in channels.items()})
    assert np.array_equal(exr.read(path), channels["Y"])


def test_luminance_and_chroma_are_rejected_and_not_read_as_gray(tmp_path):
    path = wrote(tmp_path / "x.exr", channels_of(["Y", "RY", "BY"]))
    with pytest.raises(FileFormatError, match=r"x\.exr: .*luminance and chroma"):
        exr.read(path)


def test_subsampled_chroma_is_rejected_as_luminance_and_chroma(tmp_path):
    """As OpenEXR's own programs write it: RY and BY have half the rows and columns."""
    path = wrote(tmp_path / "x.exr", {name: np.ones((4, 6), "f4") for name in ("Y", "RY", "BY")})
    data = path.read_bytes()
    for name in (b"RY", b"BY"):
        at = data.index(name + b"\0") + len(name) + 1 + 8
        data = data[:at] + np.array([2, 2], "<i4").tobytes() + data[at + 8 :]
    path.write_bytes(data)
    with pytest.raises(FileFormatError, match=r"x\.exr: .*luminance and chroma"):
        exr.read(path)


def test_layers_of_mixed_types_are_read(tmp_path):
    channels = channels_of("RGB")
    path = wrote(tmp_path / "x.exr", {name: plane.copy() for name, plane in channels.items()})
    (layer,) = read_layers(path).values()
    assert np.array_equal(layer, np.stack([channels[name] for name in "RGB"], axis=-1))


def test_impossible_chromaticities_are_rejected(tmp_path):
    path = wrote(tmp_path / "x.exr", {"RGB": RGB}, chromaticities=(0.0,) * 8)
    with pytest.raises(FileFormatError, match=r"x\.exr: .*primaries"):
        read_radiance(path)
