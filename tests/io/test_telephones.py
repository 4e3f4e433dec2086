"""Files from phones: their formats, their colors, and a film appended to a photo."""

import struct

import cv2
import imagecodecs
import numpy as np
import pillow_heif
import pytest
import tifffile
from PIL import Image
from scipy.ndimage import gaussian_filter
from support.codec_features import require_avif, require_avif_primaries

from hdrlab.core import gamut
from hdrlab.core.colour import decode_srgb, encode_srgb
from hdrlab.io.decode import read_header
from hdrlab.io.photos import read_bracket, read_photo, write_picture
from hdrlab.radiance.merge import merge

RNG = np.random.default_rng(0)
RGB = gaussian_filter(RNG.uniform(0, 1, (40, 56, 3)), (4, 4, 0))
RGB = np.uint8(20 + 220 * (RGB - RGB.min()) / np.ptp(RGB))
DEEP = np.uint16(RGB) * 4 + 3  # of 10 bits; 1023 would be white
P3 = (0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290)
ADOBE = (0.64, 0.33, 0.21, 0.71, 0.15, 0.06, 0.3127, 0.3290)
D50 = np.array([0.9642, 1, 0.8249])
MADE = {"webp": "WEBP", "avif": "AVIF", "heic": "HEIF", "jfif": "JPEG"}
pillow_heif.register_heif_opener()


def tags(seconds=0.25, orientation=1):
    exif = Image.Exif()
    exif[0x010F] = "Maker"
    exif[0x0112] = orientation
    exif.get_ifd(0x8769).update({33434: seconds, 33437: 2.0, 34855: 80})
    return exif


def save(path, image=RGB, **options):
    """Write an image with Pillow, with EXIF, in the format of the suffix or of `format`."""
    kind = options.pop("format", None) or MADE.get(path.suffix[1:].lower())
    if kind == "AVIF":
        require_avif()
    exif = tags(options.pop("seconds", 0.25), options.pop("orientation", 1))
    Image.fromarray(image).save(path, format=kind, exif=exif, quality=95, **options)
    return path


def profile(primaries, gamma=None):
    """Return an ICC profile of RGB with these primaries, and the curve of sRGB or a gamma."""

    def fixed(*values):
        return struct.pack(f">{len(values)}i", *(round(65536 * value) for value in values))

    XYZ = gamut.xyz_matrix(primaries)
    cone = (gamut.BRADFORD @ D50) / (gamut.BRADFORD @ XYZ.sum(axis=1))
    colorants = (np.linalg.inv(gamut.BRADFORD) @ np.diag(cone) @ gamut.BRADFORD @ XYZ).T
    curve = (3, 2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045) if gamma is None else (0, gamma)
    para = b"para" + bytes(4) + struct.pack(">HH", curve[0], 0) + fixed(*curve[1:])
    bodies = {
        b"wtpt": b"XYZ " + bytes(4) + fixed(*D50),
        b"desc": b"desc" + struct.pack(">2I", 0, 3) + b"P3\0" + bytes(78),
    }
    bodies |= {b"cprt": b"text" + bytes(4) + b"none\0"}
    bodies |= {
        bytes([c]) + b"XYZ": b"XYZ " + bytes(4) + fixed(*colorant)
        for c, colorant in zip(b"rgb", colorants, strict=True)
    }
    bodies |= {bytes([c]) + b"TRC": para for c in b"rgb"}
    table = b""
    data = b""
    at = 132 + 12 * len(bodies)
    for name, body in bodies.items():
        body += bytes(-len(body) % 4)
        table += name + struct.pack(">2I", at + len(data), len(body))
        data += body
    head = struct.pack(
        ">I4xI4s4s4s", at + len(data), 0x04200000, b"mntr", b"RGB ", b"XYZ "
    ) + bytes(12)
    head += b"acsp" + bytes(28) + fixed(*D50) + bytes(48)
    return head + struct.pack(">I", len(bodies)) + table + data


@pytest.mark.parametrize("suffix", ["webp", "avif", "heic", "jfif", "JPG", "HEIC", "WebP"])
def test_formats_of_phones_are_read_with_their_exposure(tmp_path, suffix):
    path = save(tmp_path / f"x.{suffix}")
    assert read_header(path).exposure == pytest.approx((0.25, 2, 80))
    assert read_header(path).shape == RGB.shape
    assert np.abs(read_photo(path).astype(int) - RGB).mean() < 2
    with Image.open(path) as image:
        assert np.abs(read_photo(path).astype(int) - np.asarray(image)).max() <= 1


@pytest.mark.parametrize("suffix", ["webp", "avif"])
@pytest.mark.parametrize("orientation", range(1, 9))
def test_exif_orientation_is_applied_to_webp_and_avif(tmp_path, suffix, orientation):
    path = save(tmp_path / f"x.{suffix}", orientation=orientation)
    upright = np.asarray(cv2.imread(str(save(tmp_path / "x.jpg", orientation=orientation))))[
        ..., ::-1
    ]
    read = read_photo(path)
    assert read.shape == read_header(path).shape == upright.shape
    assert np.abs(read.astype(int) - upright).mean() < 3


def test_heic_is_rotated_only_once(tmp_path):
    """HEIF has its own rotation property.

    iPhones write the rotation in EXIF as well; it must not count twice.
    """
    for quarter_turns, orientation in (1, 8), (3, 6):
        heif = pillow_heif.from_pillow(
            Image.fromarray(np.ascontiguousarray(np.rot90(RGB, quarter_turns)))
        )
        heif.save(tmp_path / "x.heic", exif=tags(orientation=orientation).tobytes(), quality=95)
        with Image.open(tmp_path / "x.heic") as image:
            oracle = np.asarray(image)
        assert np.array_equal(read_photo(tmp_path / "x.heic"), oracle)


@pytest.mark.parametrize("named", ["x.jpg", "x.png", "x.tif"])
@pytest.mark.parametrize("kind", ["HEIF", "WEBP", "AVIF", "PNG", "JPEG"])
def test_format_is_detected_from_the_content_not_the_name(tmp_path, named, kind):
    path = save(tmp_path / named, format=kind)
    assert read_header(path).kind == kind
    assert np.abs(read_photo(path).astype(int) - RGB).mean() < 2


@pytest.mark.parametrize("bits", [10, 12])
def test_avif_keeps_all_bits_and_white_is_the_maximum(tmp_path, bits):
    require_avif()
    require_avif_primaries()
    levels = (DEEP << (bits - 10)).clip(0, 2**bits - 1)
    levels[0, 0] = 2**bits - 1
    how = {"bitspersample": bits, "primaries": 1, "transfer": 13, "matrix": 0, "pixelformat": "444"}
    (tmp_path / "x.avif").write_bytes(imagecodecs.avif_encode(levels, level=100, **how))
    read = read_photo(tmp_path / "x.avif")
    assert np.array_equal(read >> (16 - bits), levels) and read[0, 0].tolist() == [65535] * 3


def test_heic_keeps_ten_bits_and_white_is_the_maximum(tmp_path):
    levels = DEEP << 6
    levels[:16, :16] = 65535
    heif = pillow_heif.from_bytes("RGB;16", RGB.shape[1::-1], levels.tobytes())
    heif.save(tmp_path / "x.heic", quality=-1, chroma=444)
    read = read_photo(tmp_path / "x.heic")
    assert read.dtype == np.uint16 and (read[2:14, 2:14] == 65535).all()
    assert np.abs(read.astype(int) - levels).mean() < 64


def film(data):
    """Return a photo followed by a video whose data contains JPEG markers."""
    return data + b"\0\0\0\x18ftypmp42" + RNG.bytes(2000) + b"\xff\xda" + RNG.bytes(900)


def test_photo_of_a_motion_photo_is_read(tmp_path):
    for seed in range(20):
        image = np.random.default_rng(seed).integers(0, 256, (16, 24, 3), np.uint8)
        plain = save(tmp_path / "plain.jpg", image, progressive=bool(seed % 2))
        (tmp_path / "moving.jpg").write_bytes(film(plain.read_bytes()))
        assert np.array_equal(read_photo(tmp_path / "moving.jpg"), read_photo(plain))


def test_motion_photo_with_a_truncated_photo_is_rejected(tmp_path):
    data = save(tmp_path / "x.jpg").read_bytes()
    (tmp_path / "x.jpg").write_bytes(data[:-200] + bytes(300))
    with pytest.raises(ValueError, match="x.jpg: it is cut short or damaged"):
        read_photo(tmp_path / "x.jpg")


@pytest.mark.parametrize("deep", [False, True])
def test_opaque_alpha_channels_are_ignored(tmp_path, deep):
    image = np.uint16(RGB) * 257 if deep else RGB
    alpha = np.full((*RGB.shape[:2], 1), np.iinfo(image.dtype).max, image.dtype)
    cv2.imwrite(str(tmp_path / "x.png"), np.dstack([image[..., ::-1], alpha]))
    tifffile.imwrite(
        tmp_path / "x.tif",
        np.dstack([image, alpha]),
        photometric="rgb",
        extrasamples=["unassalpha"],
    )
    (tmp_path / "gray.png").write_bytes(imagecodecs.png_encode(np.dstack([image[..., :1], alpha])))
    for name in "x.png", "x.tif":
        assert read_header(tmp_path / name).shape == RGB.shape
        assert np.array_equal(read_photo(tmp_path / name), image)
    assert np.array_equal(read_photo(tmp_path / "gray.png"), image[..., 0])


@pytest.mark.parametrize("name", ["x.png", "x.tif", "x.jpg", "x.webp", "x.avif", "x.heic"])
@pytest.mark.parametrize(("primaries", "gamma"), [(P3, None), (ADOBE, 563 / 256)])
def test_colors_of_other_profiles_are_converted_in_linear_light(tmp_path, name, primaries, gamma):
    # sRGB can show these colours
    image = np.uint8(np.rint(0.5 * RGB + 0.5 * RGB.mean(axis=-1, keepdims=True)))
    path = save(
        tmp_path / name,
        image,
        icc_profile=profile(primaries, gamma),
        **({"subsampling": 0} if name == "x.jpg" else {}),
    )
    with Image.open(path) as opened:
        v = np.asarray(opened) / 255
    light = (decode_srgb(v) if gamma is None else v**gamma) @ gamut.conversion_matrix(primaries).T
    assert np.abs(read_photo(path) - 255 * encode_srgb(light.clip(0, 1))).max() < 1.2


def test_16_bit_adobe_rgb_is_converted_with_a_small_error(tmp_path):
    image = np.uint16(RGB) * 200 + 3000
    tifffile.imwrite(
        tmp_path / "x.tif", image, photometric="rgb", iccprofile=profile(ADOBE, 563 / 256)
    )
    light = (image / 65535) ** (563 / 256) @ gamut.conversion_matrix(ADOBE).T
    assert (
        np.abs(read_photo(tmp_path / "x.tif") / 257 - 255 * encode_srgb(light.clip(0, 1))).max()
        < 0.2
    )


def test_adobe_rgb_stated_only_in_exif_is_converted(tmp_path):
    exif = tags()
    exif.get_ifd(0x8769)[0xA005] = {1: "R03"}
    Image.fromarray(RGB).save(tmp_path / "a.png", exif=exif)
    Image.fromarray(RGB).save(tmp_path / "b.png", icc_profile=profile(ADOBE, 563 / 256))
    assert (
        np.abs(read_photo(tmp_path / "a.png").astype(int) - read_photo(tmp_path / "b.png")).max()
        <= 1
    )
    assert np.abs(read_photo(tmp_path / "a.png").astype(int) - RGB).max() > 5


def test_curve_of_a_profile_with_srgb_primaries_is_not_applied(tmp_path):
    save(tmp_path / "x.png", icc_profile=profile(gamut.SRGB, 1.8))
    assert np.array_equal(read_photo(tmp_path / "x.png"), RGB)


def test_damaged_profile_is_an_error_that_names_the_photo(tmp_path):
    save(tmp_path / "x.png", icc_profile=profile(P3)[:200] + bytes(300))
    with pytest.raises(ValueError, match="x.png: .*profile"):
        read_photo(tmp_path / "x.png")


@pytest.mark.parametrize(("dtype", "share"), [(np.uint8, 80), (np.uint16, 100)])
def test_brackets_in_display_p3_and_srgb_give_the_same_radiance_map(tmp_path, dtype, share):
    """Within 1 %: all pixels of a 16-bit map, and four fifths of an 8-bit one, which is rounded twice."""
    E = (decode_srgb(RGB / 255) + 0.02) ** 2
    white = np.iinfo(dtype).max
    to_p3 = np.linalg.inv(gamut.conversion_matrix(P3))
    g = np.log(decode_srgb(np.maximum(np.arange(white + 1), 0.5) / white))
    times = [0.5, 1, 2, 4, 8, 16, 32]
    for space, light in ("srgb", E), ("p3", E @ to_p3.T):
        (tmp_path / space).mkdir()
        for j, t in enumerate(times):
            levels = np.rint(white * encode_srgb((light * t).clip(0, 1))).astype(dtype)
            icc = profile(P3) if space == "p3" else None
            tifffile.imwrite(
                tmp_path / space / f"{j}.tif", levels, photometric="rgb", iccprofile=icc
            )
    maps = {}
    for space in ("srgb", "p3"):
        bracket = read_bracket(tmp_path / space, times)
        maps[space] = merge(bracket.images, bracket.times, g)
    ratio = maps["p3"] / maps["srgb"]
    assert abs(np.median(ratio) - 1) < 1e-3
    assert np.percentile(np.abs(ratio - 1), share) < 0.01


@pytest.mark.parametrize("suffix", ["webp", "avif", "heic", "jpg"])
def test_truncated_webp_avif_and_heic_are_rejected_by_name(tmp_path, suffix):
    path = tmp_path / f"x.{suffix}"
    image = RNG.integers(0, 256, (60, 80, 3), np.uint8)
    save(path, image, icc_profile=profile(P3))
    data = path.read_bytes()
    for length in range(1, len(data) - 40, len(data) // 12):
        path.write_bytes(data[:length])
        with pytest.raises(ValueError, match=f"x.{suffix}: "):
            read_photo(path)


def test_error_without_pillow_heif_says_what_to_install(tmp_path, monkeypatch):
    path = save(tmp_path / "x.heic")
    monkeypatch.setitem(__import__("sys").modules, "pillow_heif", None)
    with pytest.raises(ValueError, match=r'pip install "hdrlab\[heic\]"'):
        read_photo(path)


def test_written_pictures_without_a_profile_are_not_converted(tmp_path):
    write_picture(tmp_path / "x.png", RGB)
    assert read_header(tmp_path / "x.png").icc == b""
    assert np.array_equal(read_photo(tmp_path / "x.png"), RGB)
