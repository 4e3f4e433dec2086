"""Images for HDR screens, compared with libavif, libjxl, Pillow and OpenCV."""

import io
import zlib

import cv2
import imagecodecs
import numpy as np
import pytest
from PIL import Image
from support.codec_features import require_avif, require_avif_primaries

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
    """Run the command on a map and return the path of its output."""
    radiance.write_radiance(tmp_path / "map.exr", E)
    out = tmp_path / name
    if out.suffix == ".avif":
        require_avif_primaries()
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
def test_mean_error_of_avif_is_below_one_code_value_of_1023(place, primaries, tmp_path):
    E = scene(place)
    data = tonemap(tmp_path, E, "room.avif", "--primaries", primaries).read_bytes()
    codes = 1023 * screens.signal(light(E), primaries=primaries)
    came = imagecodecs.avif_decode(data)
    assert came.dtype == np.uint16 and came.shape == E.shape
    assert np.abs(came - codes).mean() < 1
    assert np.abs(came - codes).max() < 3


@pytest.mark.parametrize(("primaries", "colour", "matrix"), [("bt2020", 9, 9), ("p3", 12, 6)])
def test_avif_states_primaries_pq_matrix_and_full_range(primaries, colour, matrix, tmp_path):
    data = tonemap(tmp_path, scene(), "room.avif", "--primaries", primaries).read_bytes()
    at = data.index(b"nclx") + 4
    assert data[at : at + 7] == bytes((0, colour, 0, 16, 0, matrix, 0x80))
    # 10 bits, colour, no channel of fewer pixels
    assert data[data.index(b"av1C") + 6] & 0x7C == 0x40


@pytest.mark.parametrize(("primaries", "number"), [("bt2020", 9), ("p3", 12)])
def test_png_has_exact_16_bit_code_values_and_a_cicp_chunk(primaries, number, tmp_path):
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
def test_jpeg_xl_is_lossless(place, tmp_path):
    E = scene(place)
    came = imagecodecs.jpegxl_decode(
        tonemap(tmp_path, E, "room.jxl", "--headroom", "2").read_bytes()
    )
    assert came.dtype == np.float32
    assert np.array_equal(came, light(E, np.inf))
    lit = E > 0
    # one factor, and nothing is cut
    assert np.ptp(came[lit] / E[lit]) < 1e-5 * (came[lit] / E[lit]).mean()


def test_jpeg_xl_states_that_its_floats_are_linear(tmp_path):
    """The header in bits: 32-bit floats, no XYB, RGB by its number, D65, sRGB, linear."""
    data = tonemap(tmp_path, scene(shape=(96, 96)), "room.jxl").read_bytes()
    bits = "".join(f"{byte:08b}"[::-1] for byte in data[data.index(b"\xff\x0a") + 2 :][:16])
    assert bits[:9] == "1" + "11010" + "100"  # 12 times 8 rows, as many columns
    # floats, 32 bits, 8 of them an exponent
    metadata = "00" + "1" + "00" + "1110" + "0" + "00" + "0"
    linear = "0" + "0" + "00" + "10" + "10" + "0" + "01" + "0110"  # 2 + 6 = 8
    assert bits[9:].startswith(metadata + linear)


@pytest.mark.parametrize(
    ("suffix", "write"),
    [(".png", files.write_png), (".avif", files.write_avif), (".jxl", files.write_jxl)],
)
def test_a_transposed_signal_gives_the_same_file_as_its_copy(tmp_path, suffix, write):
    if suffix == ".avif":
        require_avif_primaries()
    v = np.random.default_rng(0).random((6, 8, 3)).transpose(1, 0, 2)
    write(tmp_path / f"view{suffix}", v)
    write(tmp_path / f"copy{suffix}", v.copy())
    view = (tmp_path / f"view{suffix}").read_bytes()
    assert view == (tmp_path / f"copy{suffix}").read_bytes()


def test_white_has_the_signal_of_bt_2408():
    assert screens.signal(np.ones((1, 1, 3))) == pytest.approx(0.58, abs=0.002)


def test_srgb_red_is_converted_to_bt_2020_primaries():
    """ITU-R BT.2087 table 2; gray stays gray."""
    from hdrlab.tonemap.transfer import pq_inverse

    red, gray = np.float32([[[1, 0, 0], [0.5, 0.5, 0.5]]])[0]
    mixed = pq_inverse(screens.signal(np.stack([red, gray])[None]))[0] / 203
    assert mixed[0] == pytest.approx([0.6274, 0.0691, 0.0164], abs=2e-4)
    assert mixed[1] == pytest.approx(0.5, abs=1e-5)


def test_light_has_the_brightness_of_the_picture_and_is_limited_by_the_headroom():
    E = scene()
    picture = pipeline.develop(E, "reinhard")
    hdr = screens.light(picture, E, headroom=4)
    L = colour.luminance
    assert hdr.max() == np.float32(4)
    Ld = L(colour.decode_srgb(picture / np.float32(255)))
    whole = L(screens.light(picture, E))
    lit = (Ld > 0) & (whole > 0)
    assert np.log(whole[lit]).mean() == pytest.approx(np.log(Ld[lit]).mean(), abs=1e-4)


def test_gray_map_gives_three_equal_channels(tmp_path):
    path = tonemap(tmp_path, scene()[..., 1], "wall.avif")
    came = imagecodecs.avif_decode(path.read_bytes()).astype(int)
    assert np.abs(np.ptp(came, axis=-1)).max() <= 4


def test_light_above_10000_cd_m2_has_the_largest_signal():
    assert screens.signal(np.full((1, 1, 3), 1e6)).max() == 1


@pytest.mark.parametrize(
    ("to", "name"), [("avif", "room.png"), ("png", "room.jpg"), ("jxl", "room.exr")]
)
def test_tonemap_rejects_a_suffix_that_does_not_fit_the_kind(to, name, tmp_path, capsys):
    radiance.write_radiance(tmp_path / "map.exr", scene(shape=(12, 16)))
    with pytest.raises(SystemExit) as ended:
        run(["tonemap", str(tmp_path / "map.exr"), "-o", str(tmp_path / name), "--to", to])
    message = capsys.readouterr().err
    assert ended.value.code == 2 and message.count("\n") == 1 and f".{to}" in message
    assert [file.name for file in tmp_path.iterdir()] == ["map.exr"]


def test_tonemap_writes_8_bit_png_by_default(tmp_path):
    data = tonemap(tmp_path, scene(), "room.png").read_bytes()
    assert data[24] == 8 and b"cICP" not in data


def test_failing_codec_keeps_the_old_file(tmp_path):
    (tmp_path / "room.png").write_bytes(b"before")
    with pytest.raises((ValueError, RuntimeError)):
        files.write_png(tmp_path / "room.png", np.zeros((4, 6, 7)))
    assert (tmp_path / "room.png").read_bytes() == b"before"


@pytest.mark.parametrize("name", ["room.avif", "room.png"])
def test_pq_encoding_is_noted_by_info_and_in_a_bracket(name, tmp_path, capsys):
    folder = tmp_path / "bracket"
    folder.mkdir()
    if name == "room.avif":
        require_avif()
    path = tonemap(tmp_path, scene(), name, "--to", name[-4:].strip("."))
    for k in (1, 2):
        (folder / f"{k}{path.suffix}").write_bytes(path.read_bytes())
    notes = []
    read_bracket(sorted(folder.iterdir()), [1, 2], note=notes.append)
    (warning,) = notes
    assert "HDR screen" in warning
    assert "PQ or HLG" in describe_file(path)["processing"]


def test_info_names_a_gain_map(tmp_path):
    E = scene()
    path = tonemap(tmp_path, E, "room.jpg", "--to", "ultrahdr")
    assert "gain map" in describe_file(path)["processing"]
    for name in ("plain.jpg", "plain.png"):
        assert "processing" not in describe_file(tonemap(tmp_path, E, name))


def test_gain_map_without_metadata_is_rejected_with_advice(tmp_path):
    """As Apple writes it: a second JPEG that the XMP names, without numbers."""
    parts = []
    for segments in (b"", b"http://ns.apple.com/HDRGainMap/1.0/"):
        file = io.BytesIO()
        extra = b"\xff\xe1" + (len(segments) + 2).to_bytes(2) + segments if segments else b""
        Image.fromarray(np.full((16, 24, 3), 128, np.uint8)).save(file, "JPEG", extra=extra)
        parts.append(file.getvalue())
    (tmp_path / "apple.jpg").write_bytes(b"".join(parts))
    with pytest.raises(ValueError, match="apple.jpg: .*JPEG .*gain map.*bracket, or RAW"):
        radiance.read_radiance(tmp_path / "apple.jpg")
