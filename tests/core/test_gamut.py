"""hdrlab.core.gamut: out-of-gamut colors, other primaries, invalid values."""

import numpy as np
import OpenEXR
import pytest
from hypothesis import given, strategies as st

from hdrlab.core import gamut
from hdrlab.core.colour import LUMINANCE, decode_srgb, luminance
from hdrlab.io.maps.exr import read as read_exr
from hdrlab.io.radiance import read_radiance, read_sanitized

REC2020 = (0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290)
ACES = (0.7347, 0.2653, 0, 1, 0.0001, -0.077, 0.32168, 0.33767)
values = st.floats(-1e6, 1e6, width=32)


def saturation(E):
    """Return (max - min) / max of each pixel's channels; it is 1 if a channel is 0."""
    most = E.max(axis=-1)
    least = E.min(axis=-1)
    return (most - least) / np.maximum(most, 1e-30)


def test_valid_radiance_is_not_changed():
    E = np.random.default_rng(0).random((5, 6, 3), np.float32)
    for radiance in (E, E[..., 0], np.zeros((2, 3))):
        sanitized = gamut.sanitize(radiance)
        assert np.array_equal(sanitized.E, radiance)
        assert sanitized.unknown == sanitized.infinite == sanitized.negative == sanitized.black == 0
        assert not np.shares_memory(sanitized.E, radiance)


@given(st.tuples(values, values, values))
def test_sanitize_removes_negative_channels_and_keeps_luminance_where_possible(rgb):
    E = np.array([[rgb]], np.float32)
    sanitized = gamut.sanitize(E).E
    assert np.all(sanitized >= 0) and np.all(np.isfinite(sanitized))
    true = float(E[0, 0] @ LUMINANCE)
    shown = float(np.maximum(E[0, 0], 0) @ LUMINANCE)
    repaired = float(luminance(sanitized)[0, 0])
    if E.min() >= 0 or true > 0.51 * shown:
        assert repaired == pytest.approx(true, rel=1e-4)
    else:
        assert repaired <= 0.5 * shown * (1 + 1e-5) + 1e-30, (
            "never as bright as cutting the channel off"
        )


@given(st.tuples(values, values, values))
def test_desaturate_keeps_the_hue(rgb):
    E = np.array([[rgb]], np.float32)
    for power in (1, 2):
        desaturated = gamut.desaturate(E, power=power)[0, 0].astype(float)
        before = E[0, 0].astype(float) - E[0, 0].astype(float).mean()
        after = desaturated - desaturated.mean()
        parallel = before @ after
        assert parallel >= 0 or np.abs(after).max() < 1e-4 * np.abs(E).max()
        off = after - before * (parallel / max(before @ before, 1e-30))
        assert np.abs(off).max() <= 1e-5 * np.abs(E).max() + 1e-30


def test_a_colour_of_other_primaries_stops_where_its_least_channel_is_0():
    E = np.float32([[[1.0, 0.5, -0.02]]])
    L = luminance_of(E)
    desaturated = gamut.desaturate(E)
    t = L / (L + 0.02)
    assert np.allclose(desaturated, L + t * (E - L), atol=1e-6)
    assert desaturated.min() == pytest.approx(0, abs=1e-7)


def luminance_of(E):
    return float((E @ LUMINANCE)[0, 0])


def test_slightly_negative_channels_lose_little_saturation_and_strongly_negative_ones_much():
    slightly = np.float32([[[1.0, 0.5, -0.001]]])
    deeply = np.float32([[[0.3, -0.1, 0.2]]])
    assert saturation(gamut.sanitize(slightly).E)[0, 0] > 0.99
    assert saturation(gamut.sanitize(deeply).E)[0, 0] < 0.6
    assert saturation(np.maximum(deeply, 0))[0, 0] == 1


def test_noise_around_black_is_not_strongly_colored():
    noise = 1e-3 * np.random.default_rng(2).standard_normal((60, 80, 3)).astype(np.float32) + 1e-4
    below = noise.min(axis=-1) < 0
    sanitized = gamut.sanitize(noise)
    assert sanitized.negative + sanitized.black == np.count_nonzero(below) > 3000
    kept = np.median(saturation(sanitized.E)[below & (noise.max(axis=-1) > 0)])
    cut = np.median(saturation(noise.clip(0))[below & (noise.max(axis=-1) > 0)])
    assert cut == 1 and kept < 0.6


def test_without_a_channel_above_0_a_pixel_is_black_and_a_gray_one_has_no_colour_to_lose():
    assert gamut.sanitize(np.float32([[[-1, -2, 0]]])).E.tolist() == [[[0, 0, 0]]]
    sanitized = gamut.sanitize(np.float32([[-1, 0, 2]]))
    assert sanitized.E.tolist() == [[0, 0, 2]] and sanitized.black == 1


def test_an_unknown_pixel_is_the_mean_of_its_known_neighbours_in_all_channels():
    E = np.random.default_rng(1).random((6, 7, 3)).astype(np.float32)
    spoiled = E.copy()
    spoiled[2, 3, 1] = np.nan
    spoiled[2, 4, 0] = -np.inf
    spoiled[0, 0, 2] = np.nan
    sanitized = gamut.sanitize(spoiled)
    assert sanitized.unknown == 3
    assert sanitized.infinite == sanitized.negative == sanitized.black == 0
    around = [E[y, x] for y in (1, 2, 3) for x in (2, 3, 4) if (y, x) not in ((2, 3), (2, 4))]
    assert np.allclose(sanitized.E[2, 3], np.mean(around, axis=0), atol=1e-6)
    assert np.allclose(sanitized.E[0, 0], (E[0, 1] + E[1, 0] + E[1, 1]) / 3, atol=1e-6)
    known = np.isfinite(spoiled).all(axis=-1)
    assert np.array_equal(sanitized.E[known], E[known])


def test_unknown_regions_become_black_and_infinity_becomes_the_largest_finite_value():
    E = np.full((7, 7), np.nan, np.float32)
    E[0, 0] = 5
    sanitized = gamut.sanitize(E)
    assert sanitized.E[1, 1] == pytest.approx(5)
    assert sanitized.E[6, 6] == 0
    assert sanitized.unknown == 48
    bright = gamut.sanitize(np.float32([[1, np.inf, 9, np.inf]]))
    assert bright.E.tolist() == [[1, 9, 9, 9]] and bright.infinite == 2
    assert not gamut.sanitize(np.full((3, 4, 3), np.inf)).E.any(), (
        "nothing finite to be taken for it"
    )


@pytest.mark.filterwarnings("error")
@given(st.lists(st.floats(width=32, allow_nan=True, allow_infinity=True), min_size=12, max_size=12))
def test_sanitize_returns_finite_nonnegative_radiance_for_any_floats(numbers):
    for shape in ((2, 2, 3), (3, 4)):
        E = gamut.sanitize(np.array(numbers, np.float32).reshape(shape)).E
        assert np.all(np.isfinite(E)) and np.all(E >= 0) and E.shape == shape


@pytest.mark.parametrize(
    "E", [np.zeros(3), np.zeros((2, 3, 4)), np.zeros((0, 2)), np.full((2, 2), "x")]
)
def test_invalid_images_raise_an_error(E):
    with pytest.raises(ValueError, match="radiance"):
        gamut.sanitize(E)


def test_the_luminance_of_srgb_and_the_matrix_to_xyz_are_the_standards():
    assert np.allclose(gamut.xyz_matrix(gamut.SRGB)[1], LUMINANCE, atol=1e-4)
    # IEC 61966-2-1
    standard = [
        [0.4124, 0.3576, 0.1805],
        [0.2126, 0.7152, 0.0722],
        [0.0193, 0.1192, 0.9505],
    ]
    assert np.allclose(gamut.xyz_matrix(gamut.SRGB), standard, atol=2e-4)


def test_the_matrix_between_two_primaries_of_one_white_is_the_published_one():
    published = [  # ITU-R BT.2087, inverted
        [1.6605, -0.5876, -0.0728],
        [-0.1246, 1.1329, -0.0083],
        [-0.0182, -0.1006, 1.1187],
    ]
    assert np.allclose(gamut.conversion_matrix(REC2020), published, atol=2e-4)
    assert np.allclose(gamut.conversion_matrix(gamut.SRGB), np.eye(3), atol=1e-12)


@pytest.mark.parametrize("primaries", [REC2020, ACES])
def test_conversion_between_primaries_keeps_white_and_round_trips(primaries):
    there = gamut.conversion_matrix(primaries)
    back = gamut.conversion_matrix(gamut.SRGB, primaries)
    assert np.allclose(there.sum(axis=1), 1, atol=1e-9)
    assert np.allclose(there @ back, np.eye(3), atol=1e-9)


def write_exr(path, E, primaries=None):
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    if primaries:
        header["chromaticities"] = primaries
    with OpenEXR.File(header, {"RGB": np.ascontiguousarray(E, np.float32)}) as file:
        file.write(str(path))


def test_a_file_in_other_primaries_reads_as_the_colours_that_were_meant(tmp_path):
    E = np.random.default_rng(3).uniform(0.2, 1, (4, 5, 3)).astype(np.float32)
    wide = E @ gamut.conversion_matrix(gamut.SRGB, REC2020).T.astype(np.float32)
    for name, pixels, primaries in (("a", E, None), ("b", E, gamut.SRGB), ("c", wide, REC2020)):
        write_exr(tmp_path / f"{name}.exr", pixels, primaries)
        for clean in (False, True):
            assert np.allclose(read_radiance(tmp_path / f"{name}.exr", clean=clean), E, atol=1e-5)


def test_a_green_that_srgb_lacks_is_shown_less_colourful_and_as_bright(tmp_path):
    green = np.float32([[[0, 1, 0]]])
    write_exr(tmp_path / "green.exr", green, REC2020)
    E = read_radiance(tmp_path / "green.exr")
    assert E.min() == pytest.approx(0, abs=1e-6) and E[0, 0, 1] == E.max()
    assert luminance(E)[0, 0] == pytest.approx(gamut.xyz_matrix(REC2020)[1, 1], rel=1e-3)


@pytest.mark.parametrize(
    ("place", "printed"),
    [
        ((195, 345), (175, 54, 60)),
        ((166, 342), (231, 199, 31)),
        ((224, 347), (70, 148, 73)),
        ((254, 350), (56, 61, 150)),
    ],
    ids=["red", "yellow", "green", "blue"],
)
def test_a_chart_in_aces_primaries_has_the_colours_that_are_printed_on_it(shared, place, printed):
    """Channels as fractions of their sum.

    The sRGB values are those that the chart's maker states.
    """
    y, x = place
    path = shared("openexr") / "Carrots.exr"
    true = decode_srgb(np.array(printed) / 255)
    now = read_sanitized(path).E[y - 4 : y + 5, x - 4 : x + 5].mean(axis=(0, 1))
    before = read_exr(path)[y - 4 : y + 5, x - 4 : x + 5].mean(axis=(0, 1))
    off = np.abs(now / now.sum() - true / true.sum()).max()
    taken_as_srgb = np.abs(before / before.sum() - true / true.sum()).max()
    assert off < 0.08 < taken_as_srgb


def test_sanitize_removes_the_magenta_from_the_shadows_of_a_real_map(shared):
    path = shared("openexr") / "Desk.exr"
    raw = read_exr(path)
    sanitized = read_sanitized(path)
    below = raw.min(axis=-1) < 0
    assert sanitized.negative + sanitized.black == np.count_nonzero(below) == 9354
    assert sanitized.unknown == 0
    lit = below & (raw.max(axis=-1) > 0)
    assert np.median(saturation(sanitized.E)[lit]) < 0.6
    assert np.median(saturation(raw.clip(0))[lit]) == 1
    assert np.array_equal(sanitized.E[~below], raw[~below])
    trusted = lit & (raw @ LUMINANCE > 0.51 * (raw.clip(0) @ LUMINANCE))
    assert np.allclose(luminance(sanitized.E)[trusted], (raw @ LUMINANCE)[trusted], rtol=1e-3)


def test_between_two_whites_bradford_adapts_as_published():
    d50 = (*gamut.SRGB[:6], 0.34567, 0.35850)
    # XYZ of D65 from RGB of D50
    matrix = gamut.xyz_matrix(gamut.SRGB) @ gamut.conversion_matrix(d50)
    to_d65 = matrix @ np.linalg.inv(gamut.xyz_matrix(d50))
    published = [[0.9556, -0.0230, 0.0632], [-0.0283, 1.0099, 0.0210], [0.0123, -0.0205, 1.3299]]
    assert np.allclose(to_d65, published, atol=5e-4)
