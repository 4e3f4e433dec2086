"""RAW photos, with a synthetic DNG whose radiance, white balance and clipping are known."""

import struct
import sys

import numpy as np
import pytest
import tifffile

from hdrlab.io import raw
from hdrlab.io.decode import read_header
from hdrlab.io.photos import read_bracket, read_photo, write_picture

rawpy = pytest.importorskip("rawpy", reason="RAW photographs need the extra `raw`")

BLACK = 64
SATURATED = 4095
BALANCE = np.array([2.0, 1.0, 1.5])  # what the camera multiplies its red, green and blue by
SRGB = [
    3.2404542,
    -1.5371385,
    -0.4985314,
    -0.9692660,
    1.8760108,
    0.0415560,
    0.0556434,
    -0.2040259,
    1.0572252,
]
# of a common camera
CAMERA = [
    0.6722,
    -0.0635,
    -0.0963,
    -0.4287,
    1.2460,
    0.2028,
    -0.0908,
    0.2162,
    0.5668,
]


def dng(path, scene, *, seconds=(1, 60), f_number=(8, 1), matrix=SRGB, orientation=1):
    """Write sensor values of a scene (H, W, 3), in white-balanced units above black, as a DNG."""
    sensor = np.empty(scene.shape[:2])
    for y, x, k in (0, 0, 0), (0, 1, 1), (1, 0, 1), (1, 1, 2):
        sensor[y::2, x::2] = scene[y::2, x::2, k] / BALANCE[k]
    sensor = np.clip(np.rint(sensor) + BLACK, 0, SATURATED).astype(np.uint16)
    rationals = [n for value in matrix for n in (round(value * 10000), 10000)]
    neutral = [n for value in BALANCE for n in (1000, round(value * 1000))]
    tags = [
        (33421, "H", 2, (2, 2), True),  # the colour filter: RG over GB
        (33422, "B", 4, (0, 1, 1, 2), True),
        (33434, "2I", 1, seconds, True),
        (33437, "2I", 1, f_number, True),
        (50706, "B", 4, (1, 4, 0, 0), True),
        (50708, "s", 0, "Synthetic", True),
        (50714, "H", 1, BLACK, True),
        (50717, "H", 1, SATURATED, True),
        (50721, "2i", 9, rationals, True),
        (50728, "2I", 3, neutral, True),
        (50778, "H", 1, 21, True),
        (274, "H", 1, orientation, True),
    ]
    tifffile.imwrite(path, sensor, photometric=32803, extratags=tags, metadata=None, software=False)
    return path


def flat(value):
    return np.broadcast_to(np.asarray(value, float), (64, 96, 3))


def middle(image):
    return image[20:-20, 20:-20].reshape(-1, 3).mean(axis=0)


def unit(value):
    return value / (SATURATED - BLACK) * 65535


def test_raw_values_are_linear_above_black_and_white_balanced(tmp_path):
    for value in 100, 400, 1600:
        Z = read_photo(dng(tmp_path / "x.dng", flat(value)))
        assert Z.dtype == np.uint16 and Z.shape == (64, 96, 3)
        assert middle(Z) == pytest.approx(unit(value), rel=0.01)


def test_values_of_raw_photos_are_proportional_to_the_light(tmp_path):
    dark = read_photo(dng(tmp_path / "dark.dng", flat(50)))
    bright = read_photo(dng(tmp_path / "bright.dng", flat(3200)))
    assert middle(bright) / middle(dark) == pytest.approx(64, rel=0.02)


def test_pixel_clipped_in_one_color_is_white(tmp_path):
    scene = flat((800, 4500, 800)).copy()
    scene[:, :48] = (800, 1900, 800)
    Z = read_photo(dng(tmp_path / "x.dng", scene, matrix=CAMERA))
    assert np.all(Z[10:-10, 60:-10] == 65535)
    assert np.all(Z[10:-10, 10:36, 1] < 65535)
    assert np.all(Z[10:-10, 10:36, 1] > 3 * Z[10:-10, 10:36, 0])


def test_white_balance_does_not_tint_clipped_pixels(tmp_path):
    Z = read_photo(dng(tmp_path / "x.dng", flat(20000), matrix=CAMERA))
    assert np.all(Z == 65535)


def test_colors_equal_those_of_libraw(tmp_path):
    scene = (
        np.random.default_rng(0).integers(200, 1500, (8, 12, 3)).repeat(8, axis=0).repeat(8, axis=1)
    )
    path = dng(tmp_path / "x.dng", scene, matrix=CAMERA)
    with rawpy.imread(str(path)) as file:
        theirs = file.postprocess(
            gamma=(1, 1),
            no_auto_bright=True,
            adjust_maximum_thr=0.0,
            output_bps=16,
            user_wb=list(raw.balance(path)),
        )
    ours = read_photo(path)
    assert np.abs(ours.astype(int) - theirs).max() <= 1 and np.ptp(ours) > 1000


def test_orientation_is_applied(tmp_path):
    path = dng(tmp_path / "x.dng", flat(500), orientation=6)
    assert read_header(path).shape == read_photo(path).shape == (96, 64, 3)


def test_raw_bracket_is_linear_and_has_the_cameras_times(tmp_path):
    for name, value, seconds in (
        ("a.dng", 1600, (1, 15)),
        ("b.dng", 400, (1, 60)),
        ("c.dng", 100, (1, 240)),
    ):
        dng(tmp_path / name, flat(value), seconds=seconds)
    bracket = read_bracket(tmp_path)
    assert bracket.linear and bracket.names == ("c.dng", "b.dng", "a.dng")
    assert bracket.times == pytest.approx([1 / 240, 1 / 60, 1 / 15])
    exposure = [
        middle(image)[1] / t for image, t in zip(bracket.images, bracket.times, strict=True)
    ]
    assert exposure == pytest.approx([exposure[1]] * 3, rel=0.01)


def test_bracket_of_raw_and_other_photos_is_rejected(tmp_path):
    dng(tmp_path / "a.dng", flat(100))
    write_picture(tmp_path / "b.jpg", np.zeros((64, 96, 3), np.uint8))
    with pytest.raises(
        ValueError, match="RAW photographs and others cannot be mixed: a.dng is .*, b.jpg is"
    ):
        read_bracket(tmp_path, [1, 2])


@pytest.mark.parametrize("data", [b"", b"not a photograph", b"II*\0" + bytes(100)])
def test_other_files_are_rejected_as_raw_by_name(tmp_path, data):
    (tmp_path / "x.nef").write_bytes(data)
    with pytest.raises(ValueError, match="x.nef: .*RAW photo"):
        read_photo(tmp_path / "x.nef")


def test_truncated_raw_is_rejected(tmp_path):
    path = dng(tmp_path / "x.dng", flat(100))
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 2])
    with pytest.raises(ValueError, match="x.dng"):
        read_photo(path)


def test_missing_raw_file_raises_file_not_found_error(tmp_path):
    with pytest.raises(FileNotFoundError, match="x.dng"):
        read_photo(tmp_path / "x.dng")


def test_error_without_rawpy_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "rawpy", None)
    (tmp_path / "x.dng").write_bytes(b"II*\0")
    with pytest.raises(ValueError, match=r'pip install "hdrlab\[raw\]"'):
        read_photo(tmp_path / "x.dng")


def linear_dng(path, values, **packed):
    """Write camera colours (H, W, 3) above black, without a colour filter: a linear DNG."""
    levels = np.clip(np.rint(values / BALANCE) + BLACK, 0, SATURATED).astype(np.uint16)
    tags = [
        (50706, "B", 4, (1, 4, 0, 0), True),
        (50708, "s", 0, "Synthetic", True),
        (50714, "H", 3, (BLACK,) * 3, True),
        (50717, "H", 3, (SATURATED,) * 3, True),
        (50721, "2i", 9, [n for value in SRGB for n in (round(value * 10000), 10000)], True),
        (50728, "2I", 3, [n for value in BALANCE for n in (1000, round(value * 1000))], True),
        (50778, "H", 1, 21, True),
    ]
    tifffile.imwrite(path, levels, photometric=34892, extratags=tags, metadata=None, **packed)
    return path


def test_linear_dng_without_a_mosaic_is_read(tmp_path):
    for value in 100, 400, 1600:
        Z = read_photo(linear_dng(tmp_path / "x.dng", flat(value)))
        assert Z.dtype == np.uint16 and Z.shape == (64, 96, 3)
        assert middle(Z) == pytest.approx(unit(value), rel=0.02)


def test_linear_dng_and_mosaic_of_one_scene_agree(tmp_path):
    dng(tmp_path / "a.dng", flat(400)), linear_dng(tmp_path / "b.dng", flat(100))
    bracket = read_bracket([tmp_path / "a.dng", tmp_path / "b.dng"], {"a.dng": 1.0, "b.dng": 0.25})
    assert bracket.linear
    assert middle(bracket.images[1]) / middle(bracket.images[0]) == pytest.approx(4, rel=0.03)


@pytest.mark.parametrize("order", ["<", ">"])
def test_dng_with_jpeg_xl_is_rejected_with_advice(order, tmp_path):
    if order == "<":
        path = linear_dng(tmp_path / "pro.dng", flat(400), compression=52546, tile=(32, 32))
        # another reader's
        assert np.allclose(tifffile.imread(path), flat(400) / BALANCE + BLACK, atol=1)
    else:  # tifffile cannot write this compression, so only its number is set
        path = linear_dng(tmp_path / "pro.dng", flat(400), byteorder=">")
        none = struct.pack(">HHLH", 259, 3, 1, 1)
        packed = struct.pack(">HHLH", 259, 3, 1, 52546)
        assert path.read_bytes().count(none) == 1
        path.write_bytes(path.read_bytes().replace(none, packed))
    for read in (read_header, read_photo):
        with pytest.raises(
            ValueError, match=r"pro\.dng: .* JPEG XL, .*camera to lossless JPEG"
        ) as refused:
            read(path)
        assert "\n" not in str(refused.value)


def test_other_damaged_dng_is_not_reported_as_jpeg_xl(tmp_path):
    path = dng(tmp_path / "x.dng", flat(100))
    path.write_bytes(path.read_bytes()[:400])
    with pytest.raises(ValueError, match=r"x\.dng") as refused:
        read_photo(path)
    assert "JPEG XL" not in str(refused.value)
