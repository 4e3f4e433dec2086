"""Radiance RGBE files: closed forms, comparisons with OpenCV and imageio, real files."""

import cv2
import imageio.v3 as iio
import numpy as np
import pytest
from hypothesis import given, strategies as st

from hdrlab.errors import FileFormatError
from hdrlab.io.maps import rgbe
from hdrlab.io.maps.rgbe import read_header
from hdrlab.io.radiance import read_radiance

SIZES = [(1, 1), (3, 7), (5, 8), (130, 127), (4, 129), (2, 514), (1, 32767), (1, 32768), (2, 40000)]


def scene(height, width, *, seed=0):
    """Return radiance over ten decades with flat parts, so that there are runs and literals."""
    rng = np.random.default_rng(seed)
    E = np.exp(rng.normal(0, 4, (height, width, 3))).astype(np.float32)
    E[:, width // 3 : width // 2] = 0.25
    E[height // 2 :, : width // 4] = 0
    return E


def opencv(path):
    return cv2.imread(str(path), cv2.IMREAD_UNCHANGED)[..., ::-1]


def file(path, pixels, *, header="", resolution=None, first="#?RADIANCE"):
    """Write pixels (H, W, 4) without run lengths, under any header."""
    height, width = pixels.shape[:2]
    resolution = resolution or f"-Y {height} +X {width}"
    path.write_bytes(
        f"{first}\n{header}\n{resolution}\n".encode() + pixels.astype(np.uint8).tobytes()
    )
    return path


def test_one_mantissa_step_is_a_256th_of_the_power_of_two():
    pixels = np.array([[[128, 64, 1, 129], [255, 0, 0, 128], [1, 2, 3, 0]]], np.uint8)
    expected = [[[1, 0.5, 1 / 128], [255 / 256, 0, 0], [0, 0, 0]]]
    assert np.array_equal(rgbe.to_radiance(pixels), np.array(expected, np.float32))


def test_pixels_of_the_slides_decode_to_their_values():
    E = rgbe.to_radiance(np.array([[[145, 215, 87, 149], [145, 215, 87, 103]]], np.uint8))
    assert E[0, 0].tolist() == [1187840, 1761280, 712704]
    assert E[0, 1] == pytest.approx(np.array([145, 215, 87]) / 256 * 2.0**-25, rel=1e-6)


def test_largest_mantissa_is_at_least_128_and_the_error_below_1_in_128():
    E = scene(20, 30)
    E = np.where(E.max(axis=-1, keepdims=True) < 1e-30, 1, E).astype(np.float32)
    pixels = rgbe.to_pixels(E)
    lost = E - rgbe.to_radiance(pixels)
    assert pixels[..., :3].max(axis=-1).min() >= 128
    assert lost.min() >= 0 and np.all(lost < E.max(axis=-1, keepdims=True) / 128)


@pytest.mark.parametrize("size", SIZES)
def test_written_pixels_equal_the_equations(tmp_path, size):
    E = scene(*size)
    rgbe.write(tmp_path / "x.hdr", E)
    assert np.array_equal(rgbe.read(tmp_path / "x.hdr"), rgbe.to_radiance(rgbe.to_pixels(E)))


@pytest.mark.parametrize("size", SIZES)
def test_rgbe_files_can_be_exchanged_with_opencv_bit_for_bit(tmp_path, size):
    E = scene(*size)
    rgbe.write(tmp_path / "ours.hdr", E)
    cv2.imwrite(str(tmp_path / "theirs.hdr"), np.ascontiguousarray(E[..., ::-1]))
    ours = rgbe.read(tmp_path / "ours.hdr")
    assert ours.dtype == np.float32 and ours.flags.c_contiguous
    assert np.array_equal(opencv(tmp_path / "ours.hdr"), ours)
    assert np.array_equal(rgbe.read(tmp_path / "theirs.hdr"), ours)
    assert np.array_equal(opencv(tmp_path / "theirs.hdr"), ours)


def test_imageio_reads_written_rgbe_bit_for_bit(tmp_path):
    rgbe.write(tmp_path / "x.hdr", scene(20, 30))
    theirs = iio.imread(tmp_path / "x.hdr", plugin="opencv", flags=cv2.IMREAD_UNCHANGED)
    assert np.array_equal(theirs, rgbe.read(tmp_path / "x.hdr"))


def test_file_size_is_within_one_percent_of_opencvs(tmp_path):
    E = np.repeat(scene(64, 128, seed=1), 5, axis=1)
    rgbe.write(tmp_path / "ours.hdr", E)
    cv2.imwrite(str(tmp_path / "theirs.hdr"), np.ascontiguousarray(E[..., ::-1]))
    ours = (tmp_path / "ours.hdr").stat().st_size
    theirs = (tmp_path / "theirs.hdr").stat().st_size
    assert ours < E.size / 3 * 4 / 2 and abs(ours - theirs) <= theirs / 100


@given(
    st.integers(1, 20),
    st.integers(1, 40),
    st.floats(1e-25, 1e25),
    st.sampled_from([0.0, 1.0, 9.0]),
    st.integers(0, 9),
)
def test_a_second_round_trip_changes_nothing(tmp_path_factory, height, width, scale, spread, seed):
    path = tmp_path_factory.mktemp("rgbe") / "x.hdr"
    noise = np.random.default_rng(seed).normal(0, spread, (height, width, 3))
    rgbe.write(path, np.float32(scale) * np.exp2(noise).astype(np.float32))
    once = rgbe.read(path)
    rgbe.write(path, once)
    assert np.array_equal(rgbe.read(path), once)


def test_gray_is_written_as_three_equal_channels(tmp_path):
    L = np.exp2(np.arange(-20.0, 20)).reshape(4, 10)
    rgbe.write(tmp_path / "x.hdr", L)
    assert np.array_equal(rgbe.read(tmp_path / "x.hdr"), np.repeat(L[..., None], 3, axis=-1))


def test_values_near_the_ends_of_the_range_are_kept_or_become_black(tmp_path):
    E = np.array([[1.5 * 2.0**126, 1e-31, 1e-33, 1e-45]], np.float32)
    rgbe.write(tmp_path / "x.hdr", E)
    assert rgbe.read(tmp_path / "x.hdr")[0, :, 0] == pytest.approx(
        [E[0, 0], 1e-31, 0, 0], rel=1 / 128
    )


@pytest.mark.parametrize(
    ("value", "says"),
    [
        (np.nan, "1 NaN"),
        (np.inf, "1 infinite"),
        (-1.0, "1 negative"),
        (1.8e38, r"below 2\^127 for RGBE"),
    ],
)
def test_values_beyond_rgbe_are_rejected_and_the_old_file_is_kept(tmp_path, value, says):
    path = tmp_path / "x.hdr"
    rgbe.write(path, np.ones((3, 3)))
    before = path.read_bytes()
    E = np.ones((3, 3))
    E[1, 1] = value
    with pytest.raises(ValueError, match=says):
        rgbe.write(path, E)
    assert path.read_bytes() == before and len(list(tmp_path.iterdir())) == 1


ORIENTATIONS = {
    "-Y {h} +X {w}": lambda a: a,
    "-Y {h} -X {w}": np.fliplr,
    "+Y {h} +X {w}": np.flipud,
    "+Y {h} -X {w}": lambda a: a[::-1, ::-1],
    "+X {w} -Y {h}": lambda a: a.swapaxes(0, 1),
    "-X {w} -Y {h}": lambda a: np.fliplr(a).swapaxes(0, 1),
    "+X {w} +Y {h}": lambda a: np.flipud(a).swapaxes(0, 1),
    "-X {w} +Y {h}": lambda a: a[::-1, ::-1].swapaxes(0, 1),
}


@pytest.mark.parametrize("resolution", ORIENTATIONS)
@pytest.mark.parametrize("size", [(5, 7), (20, 30)])
def test_all_eight_orientations_are_read_upright(tmp_path, resolution, size):
    height, width = size
    upright = rgbe.to_pixels(scene(height, width))
    stored = np.ascontiguousarray(ORIENTATIONS[resolution](upright))
    path = file(tmp_path / "x.hdr", stored, resolution=resolution.format(h=height, w=width))
    assert np.array_equal(rgbe.read(path), rgbe.to_radiance(upright))


def test_run_length_scanlines_may_be_columns(tmp_path):
    E = scene(20, 30)
    rgbe.write(tmp_path / "x.hdr", np.ascontiguousarray(E.swapaxes(0, 1)))
    data = (tmp_path / "x.hdr").read_bytes().replace(b"-Y 30 +X 20", b"+X 30 -Y 20")
    (tmp_path / "x.hdr").write_bytes(data)
    assert np.array_equal(rgbe.read(tmp_path / "x.hdr"), rgbe.to_radiance(rgbe.to_pixels(E)))


def test_oldest_run_lengths_repeat_the_previous_pixel(tmp_path):
    a = [10, 200, 30, 130]
    b = [200, 20, 3, 120]
    coded = [a, [1, 1, 1, 3], b, [1, 1, 1, 2], [1, 1, 1, 1], a]  # 1 + 3, 1 + 2 + 256, 1 pixels
    expected = np.array([a] * 4 + [b] * 259 + [a], np.uint8).reshape(2, 132, 4)
    path = file(tmp_path / "x.hdr", np.array([coded]), resolution="-Y 2 +X 132")
    assert np.array_equal(rgbe.read(path), rgbe.to_radiance(expected))


@pytest.mark.parametrize(
    "coded", [[[1, 1, 1, 5]], [[9, 9, 200, 130], [1, 1, 1, 9]], [[9, 9, 200, 130], [1, 1, 1, 3]]]
)
def test_oldest_run_lengths_must_fill_the_image_exactly(tmp_path, coded):
    path = file(tmp_path / "x.hdr", np.array([coded]), resolution="-Y 1 +X 6")
    with pytest.raises(ValueError, match=r"x.hdr: .*1 scanlines of 6 pixels"):
        rgbe.read(path)


def test_header_exposures_are_multiplied_and_divided_out(tmp_path):
    pixels = rgbe.to_pixels(scene(4, 5))
    header = "EXPOSURE=2.0\nSOFTWARE=x\nEXPOSURE= 8\nCOLORCORR= 1 2 4\n"
    E = rgbe.read(file(tmp_path / "x.hdr", pixels, header=header))
    assert np.array_equal(E, rgbe.to_radiance(pixels) / np.array([16, 32, 64], np.float32))
    assert read_header(tmp_path / "x.hdr").exposure.tolist() == [16, 32, 64]


@pytest.mark.parametrize(
    "line", ["EXPOSURE=0", "EXPOSURE=-1", "EXPOSURE=nan", "EXPOSURE=bright", "COLORCORR=1 2"]
)
def test_invalid_header_exposures_are_rejected(tmp_path, line):
    with pytest.raises(ValueError, match="x.hdr: .* in its header"):
        rgbe.read(file(tmp_path / "x.hdr", rgbe.to_pixels(scene(4, 5)), header=line + "\n"))


@pytest.mark.parametrize(
    "first", ["#?RGBE", "VIEW= -vtv\n#?RADIANCE", "#?RADIANCE\n# made by hand"]
)
def test_magic_line_may_differ_and_need_not_be_first(tmp_path, first):
    pixels = rgbe.to_pixels(scene(4, 5))
    assert np.array_equal(
        rgbe.read(file(tmp_path / "x.hdr", pixels, first=first)), rgbe.to_radiance(pixels)
    )


def test_xyze_is_rejected_by_name(tmp_path):
    path = file(tmp_path / "x.hdr", np.ones((4, 5, 4)), header="FORMAT=32-bit_rle_xyze\n")
    with pytest.raises(ValueError, match="x.hdr: .*FORMAT=32-bit_rle_rgbe.*.32-bit_rle_xyze"):
        rgbe.read(path)


def test_error_for_a_file_copied_as_text_says_so(tmp_path):
    path = file(tmp_path / "x.hdr", np.ones((4, 5, 4)))
    path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    with pytest.raises(ValueError, match="x.hdr: .*CR LF"):
        rgbe.read(path)


@pytest.mark.parametrize(
    "data",
    [b"", b"\x89PNG\r\n\x1a\n", b"#?RADIANCE\n", b"#?RADIANCE\n\n-Y 3 +Y 4\n", b"-Y 1 +X 1\n1234"],
)
def test_other_files_are_rejected_as_rgbe_by_name(tmp_path, data):
    (tmp_path / "x.hdr").write_bytes(data)
    with pytest.raises(ValueError, match="x.hdr"):
        rgbe.read(tmp_path / "x.hdr")


@pytest.mark.parametrize("coded", [True, False])
def test_truncated_rgbe_is_rejected(tmp_path, coded):
    path = tmp_path / "x.hdr"
    if coded:
        rgbe.write(path, scene(40, 50))
    else:
        file(path, rgbe.to_pixels(scene(40, 50)))
    data = path.read_bytes()
    for length in (*range(len(data) - 1, 60, -97), *range(60)):
        path.write_bytes(data[:length])
        with pytest.raises(ValueError, match="x.hdr.*(cut short|expected)"):
            rgbe.read(path)


@pytest.mark.parametrize(
    "resolution", ["-Y 65536 +X 32768", "-Y 2147483648 +X 1", "-Y 0 +X 5", "-Y 9999 +X 9999"]
)
@pytest.mark.parametrize("begin", [b"\2\2\x80\0", b"\2\2\x27\x0f", b"abcd"])
def test_header_with_an_absurd_size_allocates_no_memory(tmp_path, resolution, begin):
    (tmp_path / "x.hdr").write_bytes(
        b"#?RADIANCE\n\n" + resolution.encode() + b"\n" + begin + bytes(1000)
    )
    with pytest.raises(ValueError, match="x.hdr: its header claims"):
        rgbe.read(tmp_path / "x.hdr")


def test_scanlines_of_another_length_than_in_the_header_are_rejected(tmp_path):
    rgbe.write(tmp_path / "x.hdr", scene(4, 20))
    data = (tmp_path / "x.hdr").read_bytes()
    (tmp_path / "x.hdr").write_bytes(data.replace(b"+X 20", b"+X 19"))
    with pytest.raises(ValueError, match="x.hdr: .*scanlines of 19 pixels.*one of 20"):
        rgbe.read(tmp_path / "x.hdr")


@pytest.mark.parametrize("name", ["city", "esplanade", "hall", "lobby", "studio", "venice"])
def test_real_maps_decode_as_with_opencv(shared, name):
    path = shared("hdri_cc0") / f"{name}.hdr"
    E = rgbe.read(path)
    assert E.shape == (512, 1024, 3) and np.array_equal(E, opencv(path))


def test_memorial_map_is_read_although_its_magic_line_is_second(shared):
    path = shared("memorial") / "memorial.hdr"
    E = rgbe.read(path)
    low, high = np.percentile(E[..., 1], [0.1, 99.9])
    assert E.shape == (768, 512, 3) and 14 < np.log2(high / low) < 16
    assert read_header(path).lines[0].startswith("VIEW=")


def run_length_scanline(row):
    """Return a run-length scanline of pixels (W, 4), half of it literals and half runs."""
    coded = bytearray(b"\2\2" + len(row).to_bytes(2, "big"))
    half = len(row) // 2
    for channel in row.T:
        for start in range(0, half, 100):
            literals = channel[start : min(start + 100, half)]
            coded += bytes([len(literals), *literals])
        for value in channel[half:]:
            coded += bytes([128 + 1, value])
    return bytes(coded)


def repeated_scanline(row):
    """Return a scanline of one color by the oldest run lengths."""
    repetitions = len(row) - 1
    coded = bytes(row[0])
    while repetitions > 0:
        coded += bytes([1, 1, 1, repetitions % 256])
        repetitions //= 256
    return coded


CODINGS = {
    "flat": lambda row: row.tobytes(),
    "runs": run_length_scanline,
    "repeats": repeated_scanline,
}


def mixed_file(path, order, width):
    """Write a file whose scanlines use these codings in this order, and return its pixels."""
    rng = np.random.default_rng(3)
    rows = []
    data = b""
    for coding in order.split():
        row = rng.integers(4, 250, (width, 4)).astype(np.uint8)  # above 2 and 1, which are marks
        row[:, 3] = rng.integers(120, 136, width)
        if coding == "repeats":
            row[:] = row[0]
        rows.append(row)
        data += CODINGS[coding](row)
    header = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {len(rows)} +X {width}\n"
    path.write_bytes(header.encode() + data)
    return np.array(rows)


@pytest.mark.parametrize(
    "order",
    ["flat runs", "runs flat", "repeats runs flat", "runs runs repeats", "flat flat runs repeats"],
)
@pytest.mark.parametrize("width", [8, 130, 513, 514])
def test_each_scanline_may_be_coded_in_its_own_way(tmp_path, order, width):
    """As in Radiance, the first bytes of each scanline state its coding."""
    path = tmp_path / "x.hdr"
    pixels = mixed_file(path, order, width)
    assert np.array_equal(rgbe.read(path), rgbe.to_radiance(pixels))


@pytest.mark.parametrize("order", ["flat runs", "runs flat", "runs repeats runs"])
def test_truncated_files_of_mixed_scanlines_are_rejected(tmp_path, order):
    path = tmp_path / "x.hdr"
    mixed_file(path, order, 20)
    data = path.read_bytes()
    for end in range(data.index(b"+X 20\n") + 6, len(data)):
        path.write_bytes(data[:end])
        with pytest.raises(FileFormatError, match=r"x\.hdr"):
            rgbe.read(path)


@pytest.mark.parametrize("width", [514, 8])
def test_flat_pixels_that_look_like_a_mark_stay_pixels(tmp_path, width):
    """(2, 2, high, low) is a mark only where a scanline begins."""
    pixels = np.full((3, width, 4), 9, np.uint8)
    pixels[1, 3] = [2, 2, width // 256, width % 256]
    path = file(tmp_path / "x.hdr", pixels)
    assert np.array_equal(rgbe.read(path), rgbe.to_radiance(pixels))


# x, y of red, green, blue and white [ITU-R BT.2020].
BT2020 = "0.708 0.292 0.170 0.797 0.131 0.046 0.3127 0.3290"


def test_stated_primaries_are_converted_to_srgb(tmp_path):
    """By the matrix of ITU-R BT.2087, annex 2, from BT.2020 to BT.709."""
    pixels = rgbe.to_pixels(np.full((2, 3, 3), [0.5, 0.25, 0.125], np.float32))
    header = f"PRIMARIES= {BT2020}\nEXPOSURE=0.5\n"
    path = file(tmp_path / "x.hdr", pixels, header=header)
    to_bt709 = [[1.6605, -0.5876, -0.0728], [-0.1246, 1.1329, -0.0083], [-0.0182, -0.1006, 1.1187]]
    expected = np.array(to_bt709) @ [1, 0.5, 0.25]
    assert read_radiance(path)[1, 2] == pytest.approx(expected, abs=2e-4)
    assert rgbe.read(path)[1, 2].tolist() == [1, 0.5, 0.25]


@pytest.mark.parametrize(
    "stated",
    [
        "0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329",
        "0.640 0.330 0.290 0.600 0.150 0.060 0.3333 0.3333",
        f"{BT2020}\nPRIMARIES= 0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329",
        "0 0 0 0 0 0 0 0",
    ],
    ids=["sRGB", "Radiance's own", "the last line counts", "zeros for unknown ones"],
)
def test_primaries_of_srgb_of_radiance_and_unknown_ones_change_nothing(tmp_path, stated):
    pixels = rgbe.to_pixels(scene(4, 5))
    path = file(tmp_path / "x.hdr", pixels, header=f"PRIMARIES= {stated}\n")
    assert np.array_equal(read_radiance(path), rgbe.to_radiance(pixels))


@pytest.mark.parametrize("stated", ["", "wide", "0.3 0.3", " ".join("1" * 8)])
def test_impossible_primaries_are_rejected(tmp_path, stated):
    pixels = rgbe.to_pixels(scene(4, 5))
    path = file(tmp_path / "x.hdr", pixels, header=f"PRIMARIES= {stated}\n")
    with pytest.raises(FileFormatError, match=r"x\.hdr"):
        read_radiance(path)
