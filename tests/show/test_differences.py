"""Figures of a failed check: expected, answer, difference, and their alt texts."""

import numpy as np
import pytest

from hdrlab.io import web
from hdrlab.show.plots import differences

IMAGE = np.linspace(0, 1, 48).reshape(6, 8)


def test_image_shows_expected_answer_and_difference_with_a_ring_at_the_worst_pixel():
    answer = IMAGE.copy()
    answer[4, 5] += 0.5
    shown = differences.image(IMAGE, answer, what="the map")
    scale = "difference from -0.5 (purple) to 0.5 (orange)"
    assert shown.captions == ("expected", "yours", f"{scale}: worst at row 4, column 5")
    assert "off by 0.5" in shown.alts[2] and all(alt.startswith("the map") for alt in shown.alts)
    dark = np.argwhere(web.decode_picture(shown.frames[2]).max(axis=-1) < 40)  # the ring is black
    height, width = web.decode_picture(shown.frames[2]).shape[:2]
    assert np.allclose(dark.mean(axis=0), [4.5 / 6 * height, 5.5 / 8 * width], atol=3)


def test_expected_and_answer_have_the_same_scale():
    answer = np.clip(2 * IMAGE, 0, None)
    frames = differences.image(IMAGE, answer).frames
    expected = web.decode_picture(frames[0]).astype(int)
    yours = web.decode_picture(frames[1]).astype(int)
    assert yours.mean() > expected.mean() + 30


@pytest.mark.parametrize("odd", [np.nan, np.inf, -np.inf, 1e300])
def test_value_that_is_not_finite_counts_as_worst_and_does_not_change_the_scale(odd):
    answer = IMAGE.copy()
    answer[2, 3] = odd
    shown = differences.image(IMAGE, answer)
    assert "row 2, column 3" in shown.alts[2] and web.decode_picture(shown.frames[1]).std() > 20
    curve = differences.curve(IMAGE.ravel(), answer.ravel())
    assert "at 19 they differ by" in curve.alts[0]


def test_values_over_many_decades_have_a_logarithmic_scale():
    light = np.geomspace(1e-3, 1e3, 48).reshape(6, 8)
    shown = differences.image(light, light * 1.1)
    assert "logarithmic" in shown.alts[0]
    # else all but the last row is black
    assert np.std(web.decode_picture(shown.frames[0])[..., 0].mean(axis=1)) > 20


def test_worst_channel_of_a_color_image_counts():
    colour = np.repeat(IMAGE[..., None], 3, axis=-1)
    answer = colour.copy()
    answer[1, 1, 2] -= 0.25
    shown = differences.image(colour, answer)
    assert "row 1, column 1" in shown.alts[2] and "off by 0.25" in shown.alts[2]


def test_constant_image_and_all_nan_can_be_drawn():
    for answer in (np.zeros((4, 4)), np.full((4, 4), np.nan)):
        assert len(differences.image(np.zeros((4, 4)), answer).frames) == 3
        assert differences.curve(np.zeros(16), answer.ravel()).frames[0]


def test_large_image_is_reduced():
    shown = differences.image(np.zeros((900, 1200)), np.ones((900, 1200)))
    assert max(web.decode_picture(shown.frames[0]).shape) < 900


def test_difference_below_two_curves_shows_small_deviations():
    g = np.log((np.arange(256) + 1) / 128)
    equal = differences.curve(g, g, what="g").frames[0]
    different = differences.curve(g, g + 0.01 * np.sin(g), what="g").frames[0]
    alike = web.decode_picture(equal).astype(int)
    apart = web.decode_picture(different).astype(int)
    lower = 2 * len(alike) // 3
    changed = (np.abs(alike - apart).max(axis=-1) > 60).sum(axis=1)
    assert changed[lower:].sum() > changed[:lower].sum()  # above, only the ring has moved


@pytest.mark.parametrize("answer", [np.zeros((5, 8)), np.zeros(48)])
def test_answer_of_another_shape_is_rejected(answer):
    with pytest.raises(ValueError, match="of one shape"):
        differences.image(IMAGE, answer)
    with pytest.raises(ValueError, match="of one length"):
        differences.curve(np.zeros(3), answer)
