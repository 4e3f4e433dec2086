"""JPEG XL for photos and maps: its header, and comparisons with libjxl's encoder and decoder."""

import io
import struct

import imagecodecs
import numpy as np
import pytest
from PIL import Image

from hdrlab.io import jpegxl, photos, radiance, screens
from hdrlab.io.decode import read_header
from hdrlab.io.files import MAX_PIXELS
from hdrlab.show.describe import describe_file

RGB = np.random.default_rng(0).integers(0, 256, (12, 17, 3), np.uint8)
E = np.float32(2) ** np.random.default_rng(1).uniform(-8, 8, (12, 17, 3)).astype(np.float32)


def written(path, pixels, **knobs):
    path.write_bytes(imagecodecs.jpegxl_encode(pixels, **knobs))
    return path


def bits(*fields):
    """Pack fields (value, bits), one after the other, into bytes."""
    number = 0
    at = 0
    for value, count in fields:
        number = number | value << at
        at = at + count
    return number.to_bytes((at + 7) // 8, "little")


def header(*fields, frame=((1, 1),)):
    """Return the headers of a bare codestream with these fields, and of a frame, by default a usual
    one.
    """
    return b"\xff\n" + bits(*fields) + bits(*frame) + bytes(40)


@pytest.mark.papers
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float16, np.float32])
@pytest.mark.parametrize(
    "knobs", [{"lossless": True}, {"distance": 1.0}, {"usecontainer": True}], ids=str
)
def test_header_states_what_the_decoder_returns(dtype, knobs, tmp_path):
    """All codings of a size: multiples of 8, each ratio of width to height, small, large, and gray."""
    shapes = [
        (8, 8, 3),
        (64, 48),
        (5, 9, 3),
        (40, 80, 3),
        (1, 1, 3),
        (600, 17),
        (900, 1600, 3),
        (72, 96, 3),
    ]
    for shape in [*shapes, (10, 12, 3), (30, 20, 3), (20, 30), (16, 20, 3), (8, 520, 3)]:
        path = written(tmp_path / "x.jxl", np.full(shape, 1, dtype), **knobs)
        stated = jpegxl.read_header(path, path.read_bytes())
        pixels = imagecodecs.jpegxl_decode(path.read_bytes())
        assert (stated.shape, stated.dtype) == (pixels.shape, pixels.dtype)
        assert stated.bits_per_sample == 8 * pixels.itemsize
        assert stated.orientation == 1


@pytest.mark.parametrize("depth", range(9, 17))
def test_depths_above_8_bits_are_scaled_to_16_bits(depth, tmp_path):
    codes = np.linspace(0, 2**depth - 1, 12 * 17 * 3).astype(np.uint16).reshape(12, 17, 3)
    Z = photos.read_photo(written(tmp_path / "x.jxl", codes, lossless=True, bitspersample=depth))
    assert Z.dtype == np.uint16 and Z.max() == 65535 and not Z.min()
    assert np.abs(Z / 65535 - codes / (2**depth - 1)).max() <= 2.0**-depth


@pytest.mark.parametrize("levels", [RGB, RGB[..., 1], RGB.astype(np.uint16) * 257])
def test_lossless_photos_are_read_exactly(levels, tmp_path):
    path = written(tmp_path / "x.jxl", levels, lossless=True)
    Z = photos.read_photo(path)
    assert Z.dtype == levels.dtype and np.array_equal(Z, levels)
    about = describe_file(path)
    assert (about["format"], about["width"], about["height"]) == ("JXL", 17, 12)


def boxed(data, tags):
    """Return a codestream in boxes, after a box of EXIF."""
    boxes = [
        (b"JXL ", b"\r\n\x87\n"),
        (b"ftyp", b"jxl \0\0\0\0jxl "),
        (b"Exif", bytes(4) + tags.tobytes()[6:]),
    ]
    return b"".join(
        struct.pack(">I4s", len(content) + 8, name) + content
        for name, content in [*boxes, (b"jxlc", data)]
    )


@pytest.mark.parametrize("orientation", range(1, 9))
def test_repacked_jpeg_is_upright(orientation, tmp_path):
    tags = Image.Exif()
    tags[0x0112] = orientation
    file = io.BytesIO()
    Image.fromarray(RGB.repeat(8, 0).repeat(8, 1)).save(file, "JPEG", quality=98, exif=tags)
    (tmp_path / "x.jpg").write_bytes(file.getvalue())
    (tmp_path / "x.jxl").write_bytes(imagecodecs.jpegxl_encode_jpeg(file.getvalue()))
    original = photos.read_photo(tmp_path / "x.jpg").astype(int)
    repacked = photos.read_photo(tmp_path / "x.jxl").astype(int)
    assert original.shape == repacked.shape and np.abs(original - repacked).mean() < 2


def test_exposure_is_from_exif_and_orientation_from_the_codestream(tmp_path):
    tags = Image.Exif()
    tags[0x0112] = 6
    tags.get_ifd(0x8769).update({33434: 0.5, 33437: 8.0, 34855: 200})
    (tmp_path / "x.jxl").write_bytes(boxed(imagecodecs.jpegxl_encode(RGB, lossless=True), tags))
    assert np.array_equal(imagecodecs.jpegxl_decode((tmp_path / "x.jxl").read_bytes()), RGB)
    header_read = read_header(tmp_path / "x.jxl")
    assert header_read.exposure == (0.5, 8.0, 200) and header_read.orientation == 1
    assert np.array_equal(photos.read_photo(tmp_path / "x.jxl"), RGB)


def test_folder_of_jxl_photos_is_a_bracket(tmp_path):
    for name, t in ("a", 1), ("b", 4):
        written(
            tmp_path / f"{name}.jxl", np.minimum(RGB // 5 * t, 255).astype(np.uint8), lossless=True
        )
    bracket = photos.read_bracket(tmp_path, {"a.jxl": 1.0, "b.jxl": 4.0})
    assert bracket.names == ("a.jxl", "b.jxl") and np.array_equal(bracket.images[0], RGB // 5)


@pytest.mark.parametrize("light", [E, E[..., 0]])
def test_radiance_map_survives_a_round_trip_bit_for_bit(light, tmp_path):
    path = written(tmp_path / "x.jxl", light, lossless=True)
    assert np.array_equal(radiance.read_radiance(path), light)
    assert describe_file(path)["values"] == "float32"
    screens.write_jxl(path, E)
    assert np.array_equal(radiance.read_radiance(path), E)


def test_map_with_invalid_values_is_rejected_unless_cleaned(tmp_path):
    path = written(tmp_path / "x.jxl", np.where(E > 100, -1, E).astype(np.float32), lossless=True)
    with pytest.raises(ValueError, match=r"x\.jxl: .*clean=True repairs them"):
        radiance.read_radiance(path)
    assert radiance.read_radiance(path, clean=True).min() >= 0


SIZE = [(0, 1), (0, 2), (11, 9), (0, 3), (0, 2), (16, 9)]  # 12 rows, 17 columns
# 8 bits, no more channels, XYB
AS_USUAL = [(0, 1), (0, 1)]
U8 = [(0, 1), (0, 2), (1, 1), (0, 2), (1, 1)]
SRGB = [(0, 1), (0, 1), (0, 2), (1, 2)]  # not as usual, no profile, RGB, D65


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        (
            [*SIZE, *AS_USUAL, *U8, *SRGB, (2, 2), (9, 4), (0, 1), (2, 2), (6, 4)],
            "another color space",
        ),  # P3, linear
        ([*SIZE, *AS_USUAL, *U8, *SRGB, (2, 2), (7, 4)], "another color space"),  # BT.2020
        ([*SIZE, *AS_USUAL, *U8, (0, 1), (1, 1), (0, 2)], "another color space"),  # a profile
        ([*SIZE, *AS_USUAL, (0, 1), (0, 2), (1, 1), (1, 2)], "8 bits and 1 more channels"),  # alpha
        ([*SIZE, *AS_USUAL, (0, 1), (3, 2), (31, 6), (1, 1), (0, 2)], "got 32 bits"),
        ([*SIZE, (0, 1), (1, 1), (0, 3), (0, 1), (2, 2)], "an animation or a preview"),
        (
            [(0, 1), (3, 2), (1 << 29, 30), (1, 3), (1, 1), (1, 1)],
            f"expected at most {MAX_PIXELS} in all",
        ),
        ([(0, 1), (2, 2), (10_000, 18), (1, 3), (1, 1), (1, 1)], "cut short or damaged"),
    ],
)
def test_unsupported_jxl_files_are_rejected_before_decoding(fields, message, tmp_path, monkeypatch):
    monkeypatch.delattr(imagecodecs, "jpegxl_decode")
    (tmp_path / "odd.jxl").write_bytes(header(*fields))
    for read in (photos.read_photo, radiance.read_radiance):
        with pytest.raises(ValueError, match=rf"odd\.jxl: .*{message}") as refused:
            read(tmp_path / "odd.jxl")
        assert "\n" not in str(refused.value)


USUAL = [*SIZE, (1, 1), (1, 1)]
PLACED = [(1, 1), *[(0, 10)] * 2, *[(3, 2), (30_000 - 18_688, 30)] * 2, (0, 2), (1, 1)]


@pytest.mark.parametrize(
    "frame",
    [
        [
            (0, 1),
            (0, 2),
            (1, 1),
            (0, 2),
            (0, 2),
            (0, 2),
            (0, 2),
            *PLACED,
        ],  # 30,000 x 30,000 of 17 x 12
        [(0, 1), (2, 2), (1, 1), (0, 2), (0, 2), (0, 2), *PLACED],  # kept for another
        [
            (0, 1),
            (0, 2),
            (0, 1),
            (0, 2),
            (0, 2),
            (0, 6),
            (1, 2),
            (1, 2),
            (0, 8),
            (0, 1),
            (0, 2),
            (0, 1),
        ],
    ],
    ids=["larger", "kept", "one of several"],
)
def test_odd_frames_that_take_libjxl_hours_are_rejected_before_decoding(
    frame, tmp_path, monkeypatch
):
    monkeypatch.delattr(imagecodecs, "jpegxl_decode")
    (tmp_path / "odd.jxl").write_bytes(header(*USUAL, frame=frame))
    with pytest.raises(ValueError, match=r"odd\.jxl: .*one frame .*image's size"):
        photos.read_photo(tmp_path / "odd.jxl")


@pytest.mark.parametrize(
    "passes", [[(0, 2)], [(2, 2), (1, 2), (0, 4), (1, 2), (3, 2), (5, 3)]], ids=["1", "3"]
)
def test_frames_with_several_passes_are_accepted(passes, tmp_path):
    frame = [
        (0, 1),
        (0, 2),
        (0, 1),
        (2, 2),
        (111, 8),
        (0, 2),
        (0, 6),
        *passes,
        (0, 1),
        (0, 2),
        (1, 1),
    ]
    (tmp_path / "x.jxl").write_bytes(header(*USUAL, frame=frame))
    assert read_header(tmp_path / "x.jxl").shape == (12, 17, 3)


def test_codestream_is_read_from_its_own_boxes_only(tmp_path):
    """Bytes inside EXIF that look like a codestream are ignored; a codestream in several boxes is
    joined.
    """
    data = imagecodecs.jpegxl_encode(RGB, lossless=True)
    decoy = b"jxlc" + header(*SIZE, (1, 1), (1, 1))
    big = header((0, 1), (3, 2), (1 << 29, 30), (1, 3), (1, 1), (1, 1))
    for name, parts in (
        ("good", [(0, data[:9]), (1 << 31 | 1, data[9:])]),
        ("big", [(0, big[:5]), (1, big[5:])]),
    ):
        boxes = [(b"JXL ", b"\r\n\x87\n"), (b"ftyp", b"jxl \0\0\0\0jxl "), (b"Exif", decoy)]
        boxes += [(b"jxlp", struct.pack(">I", number) + part) for number, part in parts]
        box = [struct.pack(">I4s", len(content) + 8, kind) + content for kind, content in boxes]
        (tmp_path / f"{name}.jxl").write_bytes(b"".join(box))
    assert np.array_equal(photos.read_photo(tmp_path / "good.jxl"), RGB)
    with pytest.raises(ValueError, match=r"big\.jxl: its header claims .*expected at most"):
        read_header(tmp_path / "big.jxl")


@pytest.mark.parametrize("curve", [[(2, 2), (14, 4)], [(3, 2), (0, 6)]], ids=["PQ", "HLG"])
def test_pq_and_hlg_encoding_is_noted(curve, tmp_path):
    fields = [*SIZE, *AS_USUAL, *U8, *SRGB, (1, 2), (0, 1), *curve, (1, 2), (0, 2), (1, 1)]
    (tmp_path / "x.jxl").write_bytes(header(*fields))
    assert "PQ or HLG" in read_header(tmp_path / "x.jxl").processing


def test_truncated_jxl_is_rejected_by_name(tmp_path):
    for pixels, read in (RGB, photos.read_photo), (E, radiance.read_radiance):
        data = imagecodecs.jpegxl_encode(pixels, lossless=True)
        for size in (2, 12, 40, len(data) // 2, len(data) - 9):
            (tmp_path / "cut.jxl").write_bytes(data[:size])
            with pytest.raises(ValueError, match=r"cut\.jxl"):
                read(tmp_path / "cut.jxl")
