"""hdrlab.core.colour: luminance, restored colors, display encoding."""

import cv2
import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from hdrlab.core import colour

rng = np.random.default_rng(7)
E = np.exp(2 * rng.standard_normal((40, 50, 3))).astype(np.float32)
L = colour.luminance(E)
Ld = (L / (1 + L)).astype(np.float32)


def keeping_hue(E, L, Ld, *, saturation=1.0):
    """Return what `render` shows with way="hue", before it is encoded."""
    E = np.asarray(E, np.float32)
    L = np.asarray(L, np.float32)
    Ld = np.asarray(Ld, np.float32)
    return np.clip(Ld, 0, 1) if E.ndim == 2 else colour.WAYS["hue"](E, L, Ld, saturation)


BOTH = pytest.mark.parametrize("recolour", [colour.recolour, keeping_hue])


def test_luminance_weights_the_channels_and_returns_gray_unchanged():
    assert colour.luminance(np.array([[[1.0, 2.0, 3.0]]]))[0, 0] == pytest.approx(
        0.2126 + 2 * 0.7152 + 3 * 0.0722
    )
    assert np.array_equal(colour.luminance(L), L)
    assert np.allclose(colour.luminance(np.full((2, 2, 3), 7.5)), 7.5)


def test_recolour_keeps_channel_ratios_unless_a_channel_is_clipped():
    dim = np.float32(0.05) * Ld
    C = colour.recolour(E, L, dim)
    assert np.allclose(C, E / L[..., None] * dim[..., None], rtol=1e-5)
    assert np.allclose(colour.luminance(C), dim, rtol=1e-5)


@pytest.mark.parametrize("saturation", [0.4, 0.7, 1.5])
def test_recolour_follows_the_formula_for_any_saturation(saturation):
    formula = (E.astype(float) / L[..., None]) ** saturation * Ld[..., None]
    assert np.allclose(
        colour.recolour(E, L, Ld, saturation=saturation), np.clip(formula, 0, 1), atol=1e-5
    )


def test_a_channel_beyond_the_display_is_clipped_without_changing_the_others():
    E = np.array([[[1.0, 0.1, 0.2]]])
    L = colour.luminance(E)
    C = colour.recolour(E, L, np.array([[0.6]]))[0, 0]
    assert C[0] == 1 and np.allclose(C[1:], E[0, 0, 1:] / L[0, 0] * 0.6, rtol=1e-6)


@given(rgb=st.tuples(*[st.floats(0, 1e6)] * 3), ld=st.floats(0, 1), saturation=st.floats(0, 3))
@settings(max_examples=200, deadline=None)
def test_gamut_hue_stays_in_gamut_and_adds_no_light(rgb, ld, saturation):
    E = np.array([[rgb]])
    C = keeping_hue(E, colour.luminance(E), np.array([[ld]]), saturation=saturation)
    assert np.all((C >= 0) & (C <= 1))
    if saturation <= 1:
        assert colour.luminance(C)[0, 0] <= ld + 2e-6


def test_gamut_hue_keeps_the_hue_that_clipping_would_change():
    E = np.array([[[1.0, 0.5, 0.0]]])
    L = colour.luminance(E)
    Ld = np.array([[0.9]])

    def hue(C):  # the position of the middle channel between the smallest and the largest
        least, middle, greatest = np.sort(C[0, 0])
        return (middle - least) / (greatest - least)

    assert hue(keeping_hue(E, L, Ld)) == pytest.approx(0.5, abs=1e-4)
    assert hue(colour.recolour(E, L, Ld)) > 0.6


@pytest.mark.parametrize("room", [0.3, 0.49, 0.51, 0.75, 0.99])
def test_gamut_hue_desaturates_smoothly_only_near_the_gamut_boundary(
    room,
):
    E = np.array([[[1.2, 1.0, 0.9]]])
    L = colour.luminance(E)
    Ld = room / (room + 1.2 / L - 1)
    exact = E / L[..., None] * Ld[..., None]
    paler = Ld + (exact - Ld) / (1 + room**8) ** (1 / 8)
    assert np.allclose(keeping_hue(E, L, Ld), paler if room > 0.5 else exact, atol=1e-6)


def test_ratio_and_hue_agree_for_colors_in_gamut():
    dim = np.float32(0.03) * Ld
    assert np.allclose(colour.recolour(E, L, dim), keeping_hue(E, L, dim), rtol=1e-4, atol=1e-6)


@BOTH
def test_saturation_0_gives_gray_and_gray_is_unchanged(recolour):
    assert np.allclose(recolour(E, L, Ld, saturation=0), Ld[..., None], atol=1e-6)
    assert np.array_equal(recolour(L, L, Ld), Ld)
    assert np.allclose(recolour(np.dstack([L] * 3), L, Ld), Ld[..., None], rtol=1e-5)


@BOTH
@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("level", [0, 1e-45, 1e-38, 1e-12, 1e12, 1e37])
@pytest.mark.parametrize("saturation", [0.5, 1, 2])
def test_black_and_extreme_radiance_stay_within_the_display(recolour, level, saturation):
    E = np.array([[[0, 0, 0], [1, 1, 1], [1, 0, 0], [0, 0, 1]]]) * level
    C = recolour(E, colour.luminance(E), np.array([[0.3, 0.3, 0.3, 1.0]]), saturation=saturation)
    assert np.all((C >= 0) & (C <= 1))
    assert np.allclose(C[0, :2], 0.3, atol=1e-5), (
        "without light, or in gray light, the picture is gray at Ld"
    )


@pytest.mark.parametrize("verb", [colour.recolour, colour.render])
def test_shapes_nan_and_saturation_are_validated(verb):
    with pytest.raises(ValueError, match=r"L and Ld of shape \(40, 50\)"):
        verb(E, L[:-1], Ld)
    with pytest.raises(ValueError, match="1 NaN"):
        verb(E, L, np.where(np.arange(2000).reshape(L.shape) == 5, np.nan, Ld))
    with pytest.raises(ValueError, match="saturation"):
        verb(E, L, Ld, saturation=-1)


def test_srgb_matches_the_standard_and_round_trips():
    assert np.allclose(
        colour.encode_srgb([0, 0.0031308, 0.18, 0.5, 1]),
        [0, 0.04045, 0.46135, 0.735357, 1],
        atol=1e-5,
    )
    x = np.linspace(0, 1, 10001)
    assert np.allclose(colour.decode_srgb(colour.encode_srgb(x)), x, atol=2e-8)
    assert np.all(np.diff(colour.encode_srgb(x)) > 0)


def test_srgb_agrees_with_another_library():
    skimage = pytest.importorskip("skimage.color")
    # which decodes; Y of gray is its linear value
    xyz = skimage.rgb2xyz(np.dstack([np.linspace(0, 1, 256)] * 3))
    assert np.allclose(colour.decode_srgb(np.linspace(0, 1, 256)), xyz[0, :, 1], atol=1e-5)


def test_to_8bit_matches_the_formula_within_a_thirtieth_of_a_code():
    x = np.concatenate(
        [
            np.linspace(0, 0.02, 200_000),
            np.linspace(0, 1, 200_000),
            colour.decode_srgb(np.arange(256) / 255),
        ]
    )
    exact = 255 * colour.encode_srgb(x)
    codes = colour.to_8bit(x[None].astype(np.float32))[0].astype(float)
    assert np.abs(codes - exact).max() <= 0.53
    assert np.mean(codes != np.floor(exact + 0.5)) < 0.02


def test_every_8_bit_code_survives_a_round_trip_through_linear_light():
    codes = np.arange(256, dtype=np.uint8)[None]
    assert np.array_equal(colour.to_8bit(colour.decode_srgb(codes / 255)), codes)


def test_to_8bit_clips_above_white_and_raises_an_error_for_nan():
    assert colour.to_8bit(np.array([[1.0, 1.5, 1e30]])).tolist() == [[255, 255, 255]]
    with pytest.raises(ValueError, match="1 NaN"):
        colour.to_8bit(np.array([[0.5, np.nan]]))


@pytest.mark.parametrize("saturation", [1.0, 0.6])
def test_render_equals_recolour_followed_by_to_8bit(saturation):
    picture = colour.render(E, L, Ld, saturation=saturation)
    assert picture.dtype == np.uint8
    assert np.array_equal(picture, colour.to_8bit(colour.recolour(E, L, Ld, saturation=saturation)))
    assert np.array_equal(colour.render(L, L, Ld), colour.to_8bit(Ld))


def test_render_accepts_ratio_and_hue():
    for way, verb in (("ratio", colour.recolour), ("hue", keeping_hue)):
        for saturation in (1.0, 0.6):
            picture = colour.render(E, L, Ld, saturation=saturation, way=way)
            exact = colour.to_8bit(verb(E, L, Ld, saturation=saturation))
            assert np.abs(picture.astype(int) - exact).max() <= 1
            assert np.mean(picture != exact) < 1e-3
        assert np.array_equal(colour.render(L, L, Ld, way=way), colour.to_8bit(Ld))
    with pytest.raises(ValueError, match="ratio, hue.*'lab'"):
        colour.render(E, L, Ld, way="lab")


@pytest.mark.parametrize("saturation", [0.3, 1.0])
def test_hue_is_kept_by_gamut_hue_always_and_by_ratio_without_clipping(saturation):
    """Hue is the direction away from gray.

    way="hue" keeps it up to saturation 1, way="ratio" only at saturation 1.
    """

    def direction(C):
        away = (C - C.mean(axis=-1, keepdims=True)).astype(float)
        return away / np.maximum(np.linalg.norm(away, axis=-1, keepdims=True), 1e-9)

    coloured = np.ptp(E / L[..., None], axis=-1) > 0.05
    bright = np.float32(0.9) * np.ones_like(Ld)
    shown = keeping_hue(E, L, bright, saturation=saturation)
    assert np.sum(direction(shown) * direction(E), axis=-1)[coloured].min() > 0.9999
    fits = (E / L[..., None] * Ld[..., None]).max(axis=-1) < 1
    cosine = np.sum(direction(colour.recolour(E, L, Ld)) * direction(E), axis=-1)
    assert cosine[coloured & fits].min() > 0.9999
    assert cosine[coloured & ~fits].min() < 0.9


def test_to_8bit_encodes_a_gray_ramp_like_opencv():
    ramp = np.linspace(0, 1, 512, dtype=np.float32)[None]
    theirs = (
        cv2.cvtColor(cv2.cvtColor(np.dstack([ramp] * 3), cv2.COLOR_LRGB2Luv), cv2.COLOR_Luv2RGB)[
            0, :, 0
        ]
        * 255
    )
    assert np.abs(colour.to_8bit(ramp)[0] - theirs).max() < 1.0
