"""The table of formats on the site's page about photos, cell by cell, with other writers and readers."""

import io
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

import cv2
import imagecodecs
import numpy as np
import pytest
import tifffile
from PIL import Image
from support.codec_features import require_avif, require_avif_primaries, require_channel_gains

import hdrlab
from hdrlab.cli import run
from hdrlab.core.colour import decode_srgb
from hdrlab.io import photos, radiance, screens
from hdrlab.io.decode import read_header

PAGE = Path(hdrlab.__file__).parent / "course/site/pages/photographs.md"
RGB = (
    np.random.default_rng(0)
    .integers(30, 220, (4, 6, 3), np.uint8)
    .repeat(8, axis=0)
    .repeat(8, axis=1)
)
DEEP = RGB.astype(np.uint16) * 257
E = (RGB / np.float32(64)) ** 2
NO_PHOTOGRAPH = r": expected a photograph \(TIFF, JPEG, .*, JXL\), got b"
NO_MAP = r": expected a radiance file \(\.hdr, .*\), got \."


def pillow(form, mode="RGB", image=RGB, **knobs):
    if form == "AVIF":
        require_avif()
    file = io.BytesIO()
    Image.fromarray(image).convert(mode).save(file, form, **knobs)
    return file.getvalue()


def tiff(image, **knobs):
    file = io.BytesIO()
    tifffile.imwrite(file, image, photometric="rgb", **knobs)
    return file.getvalue()


def glass():
    return np.dstack([RGB, RGB[..., :1] // 2])


def heic(mode="RGB", image=RGB):
    module = pytest.importorskip("pillow_heif", reason="HEIC needs the extra `heic`")
    file = io.BytesIO()
    module.from_bytes(mode, RGB.shape[1::-1], image.tobytes()).save(file, quality=-1)
    return file.getvalue()


def avif(bits):
    require_avif()
    codes = RGB.astype(np.uint16) << (bits - 8)
    return imagecodecs.avif_encode(
        codes if bits > 8 else RGB, bitspersample=bits, pixelformat="444"
    )


def gains():
    """Return an Ultra HDR picture as libultrahdr writes it."""
    light = np.dstack([E, np.ones_like(E[..., :1])]).astype(np.float16)
    return imagecodecs.ultrahdr_encode(light, gamut=imagecodecs.ULTRAHDR.CG.BT_709)


def apples():
    """Return two JPEGs, of which the second has the name that Apple gives its gain maps, and no
    metadata.
    """
    named = b"http://ns.apple.com/HDRGainMap/1.0/"
    return pillow("JPEG") + pillow("JPEG", extra=b"\xff\xe1" + (len(named) + 2).to_bytes(2) + named)


def raw(**knobs):
    """Return a DNG with camera colors, without a mosaic."""
    pytest.importorskip("rawpy", reason="RAW photographs need the extra `raw`")
    matrix = [n for numerator in np.eye(3, dtype=int).ravel().tolist() for n in (numerator, 1)]
    tags = [
        (50706, "B", 4, (1, 4, 0, 0), True),
        (50714, "H", 3, (0,) * 3, True),
        (50708, "s", 0, "Ours", True),
    ]
    tags += [(50717, "H", 3, (65535,) * 3, True), (50721, "2i", 9, matrix, True)]
    tags += [(50728, "2I", 3, (1,) * 6, True), (50778, "H", 1, 21, True)]
    file = io.BytesIO()
    tifffile.imwrite(file, DEEP, photometric=34892, extratags=tags, metadata=None, **knobs)
    return file.getvalue()


def pfm():
    return b"PF\n48 32\n-1.0\n" + E[::-1].astype("<f4").tobytes()


def opencv(suffix):
    return cv2.imencode(suffix, np.ascontiguousarray(E[..., ::-1]))[1].tobytes()


def exr():
    """Return an OpenEXR file written by the official library."""
    OpenEXR = pytest.importorskip("OpenEXR", reason="OpenEXR is not installed")
    header = {"type": OpenEXR.scanlineimage, "compression": OpenEXR.ZIP_COMPRESSION}
    with tempfile.TemporaryDirectory() as folder, OpenEXR.File(header, {"RGB": E}) as file:
        file.write(f"{folder}/theirs.exr")
        return Path(folder, "theirs.exr").read_bytes()


# a row of the table: files by other writers, each with what it is as a photograph and as a map: a
# dtype, or the words with which it is refused
FILES = {
    "JPEG, `.jfif`, and JPEG with an appended video": [
        ("a.jpg", lambda: pillow("JPEG"), "uint8", "a JPEG with a gain map"),
        ("a.jfif", lambda: pillow("JPEG"), "uint8", NO_MAP),
        (
            "film.jpg",
            lambda: pillow("JPEG") + bytes(4) + b"ftypmp42" + bytes(99),
            "uint8",
            "with a gain map",
        ),
        (
            "ink.jpg",
            lambda: pillow("JPEG", "CMYK"),
            "CMYK, for print",
            None,
        ),
    ],
    "Ultra HDR, a JPEG with a gain map": [
        ("a.jpg", gains, "uint8", "float32"),
        ("apple.jpg", apples, "uint8", "take a bracket, or RAW"),
    ],
    "PNG": [
        ("a.png", lambda: pillow("PNG"), "uint8", NO_MAP),
        ("deep.png", lambda: imagecodecs.png_encode(DEEP), "uint16", NO_MAP),
        (
            "few.png",
            lambda: pillow("PNG", "P"),
            "expected gray or RGB of 8 or 16 bits, got a palette",
            NO_MAP,
        ),
        (
            "glass.png",
            lambda: pillow("PNG", "RGBA", glass()),
            "got an alpha channel with transparent pixels",
            NO_MAP,
        ),
    ],
    "TIFF": [
        ("a.tif", lambda: tiff(RGB), "uint8", "expected gray or RGB of floating-point samples"),
        (
            "deep.tiff",
            lambda: tiff(DEEP),
            "uint16",
            "expected gray or RGB of floating-point samples",
        ),
        (
            "light.tif",
            lambda: tiff(E),
            "expected gray or RGB of 8 or 16 bits, got 3 x float32",
            "float32",
        ),
    ],
    "WebP": [("a.webp", lambda: pillow("WEBP"), "uint8", NO_MAP)],
    "AVIF": [
        ("a.avif", lambda: pillow("AVIF"), "uint8", NO_MAP),
        ("ten.avif", lambda: avif(10), "uint16", NO_MAP),
        ("twelve.avif", lambda: avif(12), "uint16", NO_MAP),
    ],
    "JPEG XL": [
        (
            "a.jxl",
            lambda: imagecodecs.jpegxl_encode(RGB),
            "uint8",
            "floating-point samples, got 3 x uint8",
        ),
        (
            "deep.jxl",
            lambda: imagecodecs.jpegxl_encode(DEEP),
            "uint16",
            "floating-point samples, got 3 x uint16",
        ),
        (
            "light.jxl",
            lambda: imagecodecs.jpegxl_encode(E),
            "8 or 16 bits, got 3 x float32",
            "float32",
        ),
        (
            "alpha.jxl",
            lambda: imagecodecs.jpegxl_encode(glass()),
            "8 or 16 bits, .* more channels",
            None,
        ),
    ],
    "HEIC": [
        ("a.heic", heic, "uint8", NO_MAP),
        ("deep.heic", lambda: heic("RGB;16", DEEP), "uint16", NO_MAP),
    ],
    "RAW, DNG": [
        ("linear.dng", raw, "uint16", NO_MAP),
        (
            "packed.dng",
            lambda: raw(compression=52546, tile=(32, 48)),
            "does not read JPEG XL, set",
            NO_MAP,
        ),
    ],
    "RGBE (`.hdr`), OpenEXR, PFM": [
        ("a.hdr", lambda: opencv(".hdr"), NO_PHOTOGRAPH, "float32"),
        ("a.exr", exr, NO_PHOTOGRAPH, "float32"),
        ("a.pfm", pfm, NO_PHOTOGRAPH, "float32"),
    ],
}
EACH = [
    pytest.param(row, *file, id=f"{row[:8]}-{file[0]}")
    for row, files in FILES.items()
    for file in files
]


def table():
    """Return the cells of each row of the page's table, by the first cell."""
    section = PAGE.read_text("utf-8").split("## Supported formats\n\n")[1].split("\n\n")[0]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in section.splitlines()]
    assert rows[0] == ["format", "as a photo of a bracket", "as a radiance map", "written"]
    return {row[0]: row[1:] for row in rows[2:]}


def test_table_of_formats_lists_what_can_be_read():
    assert list(table()) == list(FILES)
    for row, (photograph, light, _) in table().items():
        photo_dtypes = set()
        map_dtypes = set()
        for _, _, *expected in FILES[row]:
            photo_dtypes.update(expected[:1])
            map_dtypes.update(expected[1:2])
        assert bool({"uint8", "uint16"} & photo_dtypes) == (photograph != "no"), row
        assert ("float32" in map_dtypes) == (light != "no"), row


@pytest.mark.parametrize(("row", "name", "make", "photograph", "light"), EACH)
def test_files_of_other_programs_are_read_as_documented_or_rejected_by_name(
    row, name, make, photograph, light, tmp_path
):
    path = tmp_path / name
    path.write_bytes(make())
    if photograph in ("uint8", "uint16"):
        Z = photos.read_photo(path)
        assert Z.dtype == photograph and Z.shape == RGB.shape
        if row not in ("Ultra HDR, a JPEG with a gain map", "RAW, DNG"):  # there levels are others'
            assert np.abs(Z / np.iinfo(Z.dtype).max - RGB / 255).mean() < 0.03
    else:
        with pytest.raises(ValueError, match=f"{re.escape(name)}.*{photograph}") as refused:
            photos.read_photo(path)
        assert "\n" not in str(refused.value)
    if light == "float32":
        came = radiance.read_radiance(path)
        assert came.dtype == light and came.shape == E.shape
        apart = np.log2((came + 1e-3) / (E + 1e-3))
        # stops, after its unit: RGBE and 8 bits of gain
        assert np.ptp(np.quantile(apart, [0.05, 0.95])) < 0.15
    elif light is not None:
        with pytest.raises(ValueError, match=f"{re.escape(name)}.*{light}") as refused:
            radiance.read_radiance(path)
        assert "\n" not in str(refused.value)


WRITTEN = {
    "JPEG, `.jfif`, and JPEG with an appended video": [
        ("a.jpg", [], lambda data: Image.open(data))
    ],
    "Ultra HDR, a JPEG with a gain map": [
        ("a.jpg", ["--to", "ultrahdr"], lambda data: imagecodecs.ultrahdr_decode(data.read()))
    ],
    "PNG": [
        ("a.png", [], lambda data: Image.open(data)),
        ("pq.png", ["--to", "png"], lambda data: imagecodecs.png_decode(data.read())),
    ],
    "TIFF": [("a.tif", [], tifffile.imread), ("map.tif", None, tifffile.imread)],
    "AVIF": [("a.avif", [], lambda data: imagecodecs.avif_decode(data.read()))],
    "JPEG XL": [("a.jxl", [], lambda data: imagecodecs.jpegxl_decode(data.read()))],
    "RGBE (`.hdr`), OpenEXR, PFM": [
        ("map.hdr", None, lambda data: cv2.imdecode(np.frombuffer(data.read(), np.uint8), -1)),
        ("map.pfm", None, lambda data: cv2.imdecode(np.frombuffer(data.read(), np.uint8), -1)),
    ],
}


def test_table_of_formats_lists_what_can_be_written():
    assert {row for row, (*_, written) in table().items() if written != "no"} == set(WRITTEN)
    assert not {".webp", ".heic", ".dng"} & ({*photos.PICTURES} | {*radiance.SUFFIXES})


@pytest.mark.parametrize(
    ("name", "options", "decode"),
    [
        pytest.param(*case, id=f"{row[:8]}-{case[0]}")
        for row, cases in WRITTEN.items()
        for case in cases
    ],
)
def test_other_programs_can_read_written_files(name, options, decode, tmp_path):
    if name.endswith(".avif"):
        require_avif_primaries()
    if options == ["--to", "ultrahdr"]:
        require_channel_gains()
    if options is None:
        radiance.write_radiance(tmp_path / name, E)
    else:
        radiance.write_radiance(tmp_path / "from.exr", E)
        with pytest.raises(SystemExit) as ended:
            run(["tonemap", str(tmp_path / "from.exr"), "-o", str(tmp_path / name), *options])
        assert not ended.value.code
    came = np.asarray(decode(io.BytesIO((tmp_path / name).read_bytes())))
    assert came.shape[:2] == E.shape[:2] and came.shape[2] in (3, 4) and np.ptp(came[..., :3]) > 0


def program(folder, *words):
    """Return the output of a program; skip the test if it is not installed."""
    if not shutil.which(words[0]):
        pytest.skip(f"{words[0]} is not installed")
    done = subprocess.run(words, cwd=folder, capture_output=True, check=True)
    return done.stdout


@pytest.mark.parametrize("light", [E, E[..., 0]], ids=["RGB", "gray"])
@pytest.mark.parametrize("half", [False, True])
def test_pfstools_reads_written_exr_files(light, half, tmp_path):
    radiance.write_radiance(tmp_path / "ours.exr", light, half=half)
    frame = program(tmp_path, "pfsinexr", "ours.exr")
    subprocess.run(
        ["pfsoutpfm", "theirs.pfm"], cwd=tmp_path, input=frame, capture_output=True, check=True
    )
    came = radiance.read_radiance(tmp_path / "theirs.pfm")
    came = came if light.ndim == 3 or came.ndim == 2 else came[..., 1]
    assert np.allclose(came, light, rtol=1e-3 if half else 1e-4)  # it goes by XYZ


def test_djxl_reads_written_jxl_files_bit_for_bit(tmp_path):
    screens.write_jxl(tmp_path / "ours.jxl", E)
    program(tmp_path, "djxl", "ours.jxl", "theirs.pfm")
    assert np.array_equal(radiance.read_radiance(tmp_path / "theirs.pfm"), E)
    description = program(tmp_path, "jxlinfo", "ours.jxl").decode()
    assert "48x32" in description
    assert "32-bit float" in description
    assert "sRGB primaries, Linear transfer" in description


@pytest.mark.parametrize(
    "options",
    [["-d", "0"], ["-d", "0", "-e", "9"], ["-d", "1"], ["-d", "1", "-p"], ["-d", "0", "-p"]],
    ids=" ".join,
)
@pytest.mark.parametrize("levels", [RGB, RGB[..., 1].copy(), DEEP], ids=["RGB", "gray", "16 bits"])
def test_photos_written_by_cjxl_are_read(levels, options, tmp_path):
    (tmp_path / "a.png").write_bytes(imagecodecs.png_encode(levels))
    program(tmp_path, "cjxl", "a.png", "a.jxl", *options)
    Z = photos.read_photo(tmp_path / "a.jxl")
    assert Z.dtype == levels.dtype and Z.shape == levels.shape
    off = np.abs(Z.astype(float) - levels).mean() / np.iinfo(Z.dtype).max
    assert off == 0 if options[1] == "0" else off < 0.03


def test_jpeg_repacked_by_cjxl_keeps_pixels_and_exposure(tmp_path):
    tags = Image.Exif()
    tags[0x0112] = 6
    tags.get_ifd(0x8769).update({33434: 0.5, 33437: 8.0, 34855: 200})
    (tmp_path / "a.jpg").write_bytes(pillow("JPEG", quality=95, exif=tags))
    program(tmp_path, "cjxl", "a.jpg", "a.jxl")
    assert b"brobExif" in (tmp_path / "a.jxl").read_bytes()
    original = photos.read_photo(tmp_path / "a.jpg").astype(int)
    repacked = photos.read_photo(tmp_path / "a.jxl").astype(int)
    assert original.shape == repacked.shape == (48, 32, 3)
    assert np.abs(original - repacked).mean() < 2
    assert (
        read_header(tmp_path / "a.jxl").exposure
        == read_header(tmp_path / "a.jpg").exposure
        == (0.5, 8.0, 200)
    )


@pytest.mark.parametrize("depth", [8, 16])
def test_display_p3_of_jxl_is_converted_as_in_png(depth, tmp_path):
    """Compared with the matrix of these primaries, in linear light [SMPTE EG 432-1, IEC 61966-2-1]."""
    levels = RGB if depth == 8 else DEEP
    (tmp_path / "a.ppm").write_bytes(
        b"P6\n48 32\n%d\n" % (2**depth - 1) + levels.astype(f">u{depth // 8}").tobytes()
    )
    program(tmp_path, "cjxl", "a.ppm", "a.jxl", "-d", "0", "-x", "color_space=RGB_D65_DCI_Rel_SRG")
    matrix = np.array(
        [[1.22494, -0.22494, 0], [-0.04206, 1.04206, 0], [-0.01964, -0.07864, 1.09827]]
    )
    expected = decode_srgb(levels / (2**depth - 1)) @ matrix.T
    came = decode_srgb(photos.read_photo(tmp_path / "a.jxl") / (2**depth - 1))
    shown = (expected > 0.002) & (expected < 1)
    assert np.abs(came - expected)[shown].max() < (0.01 if depth == 8 else 2e-4)
    assert not np.array_equal(came, expected)


@pytest.mark.parametrize("distance", [0, 0.1])
def test_map_written_by_cjxl_is_read_unless_nonlinear_or_animated(distance, tmp_path):
    radiance.write_radiance(tmp_path / "a.pfm", E)
    where = [f"-d {distance}", "-x color_space=RGB_D65_SRG_Rel_Lin", "--progressive_dc=1"]
    program(tmp_path, "cjxl", "a.pfm", "a.jxl", *where[0].split(), *where[1].split())
    came = radiance.read_radiance(tmp_path / "a.jxl")
    assert np.array_equal(came, E) if not distance else np.abs(came - E).mean() < 0.05 * E.mean()
    program(tmp_path, "cjxl", "a.pfm", "curved.jxl", *where[0].split())
    with pytest.raises(ValueError, match=r"curved\.jxl: .*linear floats"):
        radiance.read_radiance(tmp_path / "curved.jxl")
    program(tmp_path, "cjxl", "a.pfm", "dc.jxl", "-d", "1", *where[1].split(), where[2])
    with pytest.raises(ValueError, match=r"dc\.jxl: .*one frame .*image's size"):
        radiance.read_radiance(tmp_path / "dc.jxl")


@pytest.mark.parametrize("suffix", [".webp", ".heic", ".jfif"])
def test_write_picture_rejects_other_formats(suffix, tmp_path):
    with pytest.raises(ValueError, match=rf"a\{suffix}: .*picture file \(.*\).*\{suffix}"):
        photos.write_picture(tmp_path / f"a{suffix}", RGB)
    assert not list(tmp_path.iterdir())
