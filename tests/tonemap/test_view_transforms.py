"""Khronos PBR Neutral and AgX: closed forms, gray, range, and the hue of a blue light that gets brighter."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra.numpy import arrays

from hdrlab import pipeline, scenes
from hdrlab.core import colour, gamut
from hdrlab.tonemap import agx, khronos

VIEWS = {"khronos": khronos, "agx": agx}
COLORS = arrays(np.float64, (20, 3), elements=st.floats(0, 1e6))
# a saturated blue light, from 4 stops below 1 to 8 above
BLUE = np.array([0.02, 0.1, 1.0]) * 2.0 ** np.arange(-4, 8, 0.05)[:, None]
# Wrensch's published fit to the sigmoid of AgX
POLYNOMIAL = (15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232)


def hue(C):
    """Return the angle around the gray axis, in degrees; 240 is blue, and 180 cyan."""
    R, G, B = np.moveaxis(C, -1, 0)
    return np.degrees(np.arctan2(np.sqrt(3) * (G - B), 2 * R - G - B)) % 360


def chroma(C):
    """Return the range of the channels divided by the largest one; it is 0 for gray."""
    return np.ptp(C, axis=-1) / C.max(axis=-1)


@pytest.mark.parametrize("name", VIEWS)
@given(C=COLORS)
def test_no_color_leaves_the_display(name, C):
    display = VIEWS[name].view(C)
    assert np.all((display >= 0) & (display <= 1))


@pytest.mark.parametrize("name", VIEWS)
def test_gray_stays_gray_and_a_brighter_gray_is_never_darker(name):
    gray = np.repeat(np.geomspace(1e-5, 1e4, 400)[:, None], 3, axis=1)
    display = VIEWS[name].view(gray)
    assert np.ptp(display, axis=1).max() < 1e-9
    assert np.diff(display[:, 0]).min() >= -1e-12


@pytest.mark.parametrize("name", VIEWS)
def test_a_bright_blue_light_becomes_white(name):
    """A curve for each channel would not change the display's own blue."""
    ends = chroma(VIEWS[name].view([[0, 0, 0.5], [0, 0, 1e5]]))
    assert ends[0] > 0.8 and ends[1] < 0.01


def test_khronos_keeps_the_hue_of_every_color():
    C = np.random.default_rng(0).uniform(0, 4, (500, 3))
    assert np.allclose(hue(khronos.view(C)), hue(C), atol=1e-6)


@given(C=arrays(np.float64, (20, 3), elements=st.floats(0.08, 0.8)))
def test_khronos_only_takes_4_percent_of_gloss_from_colors_of_0_08_to_0_8(C):
    """The guarantee of the specification."""
    assert np.allclose(khronos.view(C), C - 0.04)


def test_khronos_compresses_from_0_76_without_a_kink():
    below, above = khronos.compress([0.76 - 1e-6, 0.76 + 1e-6])
    assert above - below == pytest.approx(2e-6, rel=1e-4)
    assert khronos.compress([0.76, 1.0, 1e9]) == pytest.approx([0.76, 0.88, 1])
    assert khronos.offset([0, 0.04, 0.08, 5]) == pytest.approx([0, 0.03, 0.04, 0.04])


def test_the_sigmoid_of_agx_goes_through_black_middle_gray_and_white_with_slope_2():
    p = 10 / 16.5
    assert agx.sigmoid([0, p, 1]) == pytest.approx([0, 0.5, 1])
    low, high = agx.sigmoid([p - 1e-6, p + 1e-6])
    assert (high - low) / 2e-6 == pytest.approx(2)


def test_the_sigmoid_of_agx_agrees_with_the_published_polynomial():
    """Within 1.5 levels of 255. The polynomial decreases near black; the sigmoid does not."""
    v = np.linspace(0, 1, 1001)
    assert np.abs(agx.sigmoid(v) - np.polyval(POLYNOMIAL, v)).max() < 1.5 / 255
    assert np.diff(agx.sigmoid(v)).min() > 0


def test_the_inset_of_agx_follows_from_primaries_at_1_25_times_their_distance_from_white():
    points = np.reshape(gamut.SRGB, (4, 2))
    white = points[3]
    far = (white + (points - white) / agx.OWN_FRACTION).ravel()
    assert np.allclose(agx.inset(np.eye(3)).T, gamut.conversion_matrix(gamut.SRGB, far), atol=1e-5)


@given(C=COLORS)
def test_the_outset_of_agx_undoes_its_inset(C):
    assert np.allclose(agx.outset(agx.inset(C)), C, rtol=1e-9, atol=1e-6)


def test_agx_shows_16_5_stops():
    stops = np.array([-10.5, -10, 0, 6.5, 7.0])
    gray = np.repeat(0.18 * 2.0 ** stops[:, None], 3, axis=1)
    expected = [0, 0, 0.5**2.2, 1, 1]
    assert agx.view(gray)[:, 0] == pytest.approx(expected, abs=1e-9)


def shift_toward_cyan(view):
    """Return the change of the hue in degrees at the brightness where the blue light has lost half of
    its color.
    """
    C = view(BLUE)
    halfway = np.argmin(np.abs(chroma(C) - 0.5))
    return hue(BLUE[0]) - hue(C[halfway])


def test_on_its_way_to_white_a_blue_light_turns_less_cyan_than_with_a_curve_for_each_channel():
    assert shift_toward_cyan(lambda C: C / (1 + C)) > 30
    assert 5 < shift_toward_cyan(agx.view) < 15
    assert abs(shift_toward_cyan(khronos.view)) < 1e-6


@pytest.mark.parametrize("name", VIEWS)
def test_the_unit_of_radiance_cancels_and_key_scales_exposure(name):
    E = scenes.room((48, 72))
    picture = pipeline.develop(E, name)
    assert np.array_equal(picture, pipeline.develop(1024 * E, name))
    assert pipeline.develop(E, name, key=0.36).mean() > picture.mean()


@pytest.mark.parametrize("name", VIEWS)
def test_develop_maps_colors_with_the_view_transform_and_gray_with_its_curve(name):
    E = scenes.room((48, 72))
    L = colour.luminance(E)
    rgb = colour.to_8bit(VIEWS[name].tonemap_rgb(E))
    assert np.array_equal(pipeline.develop(E, name), rgb)
    gray = pipeline.develop(L, name)
    assert np.array_equal(gray, colour.to_8bit(VIEWS[name].tonemap(L)))


@pytest.mark.parametrize("name", VIEWS)
def test_a_saturation_is_refused_and_gray_is_no_color(name):
    E = scenes.room((16, 24))
    with pytest.raises(ValueError, match=f"{name} maps colors by itself"):
        pipeline.develop(E, name, saturation=0.5)
    with pytest.raises(ValueError, match="expected colors"):
        VIEWS[name].tonemap_rgb(colour.luminance(E))
    for key in (0, -1, np.inf, np.nan):
        with pytest.raises(ValueError, match="key"):
            VIEWS[name].tonemap(colour.luminance(E), key=key)
