"""Pictures for screens that are brighter than white, against libavif, libjxl, Pillow, OpenCV."""

import io
import zlib

import cv2
import imagecodecs
import numpy as np
import pytest
from PIL import Image

from hdrlab import pipeline, scenes
from hdrlab.cli import run
from hdrlab.core import colour
from hdrlab.io import radiance, screens as files
from hdrlab.io.photos import read_bracket
from hdrlab.pipeline import screens
from hdrlab.show.describe import describe_file

PLACES = ("chapel", "workshop", "street")


def scene(name="chapel", shape=(96, 144)):
    return np.asarray(getattr(scenes, name)(shape))


def tonemap(tmp_path, E, name, *options):
    """Return the file that the command writes of a map, as Path."""
    radiance.write_radiance(tmp_path / "map.exr", E)
    out = tmp_path / name
    with pytest.raises(SystemExit) as ended:
        run(
            [
                "tonemap",
                str(tmp_path / "map.exr"),
                "-o",
                str(out),
                "--operator",
                "reinhard",
                *options,
            ]
        )
    assert not ended.value.code
    return out


def light(E, headroom=8.0):
    return screens.light(pipeline.develop(E, "reinhard"), E, headroom=headroom)


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("primaries", ["bt2020", "p3"])
def test_an_avif_is_within_a_code_of_1023_of_its_light_in_the_mean(place, primaries, tmp_path):
    E = scene(place)
    data = tonemap(tmp_path, E, "room.avif", "--primaries", primaries).read_bytes()
    codes = 1023 * screens.signal(light(E), primaries=primaries)
    came = imagecodecs.avif_decode(data)
    assert came.dtype == np.uint16 and came.shape == E.shape
    assert np.abs(came - codes).mean() < 1
    assert np.abs(came - codes).max() < 3


@pytest.mark.parametrize(("primaries", "colour", "matrix"), [("bt2020", 9, 9), ("p3", 12, 6)])
def test_an_avif_says_its_primaries_pq_and_its_matrix_in_full_range(
    primaries, colour, matrix, tmp_path
):
    data = tonemap(tmp_path, scene(), "room.avif", "--primaries", primaries).read_bytes()
    at = data.index(b"nclx") + 4
    assert data[at : at + 7] == bytes((0, colour, 0, 16, 0, matrix, 0x80))
    assert (
        data[data.index(b"av1C") + 6] & 0x7C == 0x40
    )  # 10 bits, colour, no channel of fewer pixels


@pytest.mark.parametrize(("primaries", "number"), [("bt2020", 9), ("p3", 12)])
def test_a_png_holds_every_code_of_16_bits_and_says_what_they_mean(primaries, number, tmp_path):
    E = scene()
    path = tonemap(tmp_path, E, "room.png", "--to", "png", "--primaries", primaries)
    codes = np.rint(65535 * screens.signal(light(E), primaries=primaries))
    assert np.abs(cv2.imread(str(path), cv2.IMREAD_UNCHANGED)[..., ::-1] - codes).max() == 0
    data = path.read_bytes()
    at = data.index(b"cICP")
    assert data[at - 4 : at + 8] == b"\0\0\0\4cICP" + bytes((number, 16, 0, 1))
    assert int.from_bytes(data[at + 8 : at + 12]) == zlib.crc32(data[at : at + 8])
    assert at < data.index(b"IDAT")  # as the chunk has to come before the pixels
    with Image.open(io.BytesIO(data)) as image:
        image.verify()


@pytest.mark.parametrize("place", PLACES)
def test_a_jpeg_xl_keeps_all_light_to_the_bit(place, tmp_path):
    E = scene(place)
    came = imagecodecs.jpegxl_decode(
        tonemap(tmp_path, E, "room.jxl", "--headroom", "2").read_bytes()
    )
    assert came.dtype == np.float32
    assert np.array_equal(came, light(E, np.inf))
    lit = E > 0
    assert (
        np.ptp(came[lit] / E[lit]) < 1e-5 * (came[lit] / E[lit]).mean()
    )  # one factor, and nothing is cut


def test_a_jpeg_xl_says_that_its_floats_are_linear(tmp_path):
    """Its header in bits: floats of 32 bits, not by XYB, by number RGB, D65, sRGB, linear."""
    data = tonemap(tmp_path, scene(shape=(96, 96)), "room.jxl").read_bytes()
    bits = "".join(f"{one:08b}"[::-1] for one in data[data.index(b"\xff\x0a") + 2 :][:16])
    assert bits[:9] == "1" + "11010" + "100"  # 12 times 8 rows, as many columns
    metadata = (
        "00" + "1" + "00" + "1110" + "0" + "00" + "0"
    )  # floats, 32 bits, 8 of them an exponent
    linear = "0" + "0" + "00" + "10" + "10" + "0" + "01" + "0110"  # 2 + 6 = 8
    assert bits[9:].startswith(metadata + linear)


def test_white_has_the_signal_of_bt_2408():
    assert screens.signal(np.ones((1, 1, 3))) == pytest.approx(0.58, abs=0.002)


def test_a_red_of_srgb_is_mixed_of_wider_primaries():
    """ITU-R BT.2087 table 2; gray stays gray."""
    from hdrlab.tonemap.transfer import pq_inverse

    red, gray = np.float32([[[1, 0, 0], [0.5, 0.5, 0.5]]])[0]
    mixed = pq_inverse(screens.signal(np.stack([red, gray])[None]))[0] / 203
    assert mixed[0] == pytest.approx([0.6274, 0.0691, 0.0164], abs=2e-4)
    assert mixed[1] == pytest.approx(0.5, abs=1e-5)


def test_the_light_of_a_map_is_as_bright_as_its_picture_and_ends_at_the_headroom():
    E = scene()
    picture = pipeline.develop(E, "reinhard")
    hdr, L = screens.light(picture, E, headroom=4), colour.luminance
    assert hdr.max() == np.float32(4)
    Ld, whole = L(colour.decode_srgb(picture / np.float32(255))), L(screens.light(picture, E))
    lit = (Ld > 0) & (whole > 0)
    assert np.log(whole[lit]).mean() == pytest.approx(np.log(Ld[lit]).mean(), abs=1e-4)


def test_a_gray_map_has_three_channels_alike(tmp_path):
    path = tonemap(tmp_path, scene()[..., 1], "wall.avif")
    came = imagecodecs.avif_decode(path.read_bytes()).astype(int)
    assert np.abs(np.ptp(came, axis=-1)).max() <= 4


def test_light_beyond_10_000_cd_m2_has_the_largest_code():
    assert screens.signal(np.full((1, 1, 3), 1e6)).max() == 1


@pytest.mark.parametrize(
    ("to", "name"), [("avif", "room.png"), ("png", "room.jpg"), ("jxl", "room.exr")]
)
def test_a_suffix_of_another_kind_is_refused_in_one_line_and_nothing_is_written(
    to, name, tmp_path, capsys
):
    radiance.write_radiance(tmp_path / "map.exr", scene(shape=(12, 16)))
    with pytest.raises(SystemExit) as ended:
        run(["tonemap", str(tmp_path / "map.exr"), "-o", str(tmp_path / name), "--to", to])
    said = capsys.readouterr().err
    assert ended.value.code == 2 and said.count("\n") == 1 and f".{to}" in said
    assert [one.name for one in tmp_path.iterdir()] == ["map.exr"]


def test_a_png_without_to_is_a_picture_of_8_bits_as_before(tmp_path):
    data = tonemap(tmp_path, scene(), "room.png").read_bytes()
    assert data[24] == 8 and b"cICP" not in data


def test_what_is_there_stays_where_the_codec_fails(tmp_path):
    (tmp_path / "room.png").write_bytes(b"before")
    with pytest.raises((ValueError, RuntimeError)):
        files.write_png(tmp_path / "room.png", np.zeros((4, 6, 7)))
    assert (tmp_path / "room.png").read_bytes() == b"before"


@pytest.mark.parametrize("name", ["room.avif", "room.png"])
def test_codes_of_pq_are_told_of_where_a_file_is_described_and_where_it_stands_in_a_bracket(
    name, tmp_path, capsys
):
    folder = tmp_path / "bracket"
    folder.mkdir()
    path = tonemap(tmp_path, scene(), name, "--to", name[-4:].strip("."))
    for k in (1, 2):
        (folder / f"{k}{path.suffix}").write_bytes(path.read_bytes())
    said = []
    read_bracket(folder, [1, 2], note=said.append)
    (warning,) = said
    assert "HDR screen" in warning
    assert "PQ or HLG" in describe_file(path)["processing"]


def test_a_gain_map_is_named_where_its_file_is_described_and_a_plain_picture_says_nothing(tmp_path):
    E = scene()
    path = tonemap(tmp_path, E, "room.jpg", "--to", "ultrahdr")
    assert "gain map" in describe_file(path)["processing"]
    for name in ("plain.jpg", "plain.png"):
        assert "processing" not in describe_file(tonemap(tmp_path, E, name))


def test_a_gain_map_that_does_not_say_its_meaning_is_refused_with_what_to_do(tmp_path):
    """Apple's: a second JPEG whose XMP names it, and no numbers."""
    parts = []
    for segments in (b"", b"http://ns.apple.com/HDRGainMap/1.0/"):
        file = io.BytesIO()
        extra = b"\xff\xe1" + (len(segments) + 2).to_bytes(2) + segments if segments else b""
        Image.fromarray(np.full((16, 24, 3), 128, np.uint8)).save(file, "JPEG", extra=extra)
        parts.append(file.getvalue())
    (tmp_path / "apple.jpg").write_bytes(b"".join(parts))
    with pytest.raises(ValueError, match="apple.jpg: .*JPEG .*gain map.*bracket, or RAW"):
        radiance.read_radiance(tmp_path / "apple.jpg")
