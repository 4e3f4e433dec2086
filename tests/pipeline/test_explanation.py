"""Assembly.why: the radiance that each photo gives for a pixel, and how the map combines them."""

from dataclasses import replace

import numpy as np
import pytest

from hdrlab import pipeline, scenes
from hdrlab.capture import camera, movers
from hdrlab.core import colour, weights
from hdrlab.core.bracket import bracket
from hdrlab.errors import InputError
from hdrlab.pipeline.explanation import shorten
from hdrlab.pipeline.pixel_claims import Role, collect_claims
from hdrlab.radiance.merge import METHODS, Quality, merge_with_quality

# float32 has 24 bits; the sums of the merge round a few of their last ones
FLOAT32_ROUNDING = 2e-6

pytestmark = pytest.mark.papers


def combine(claims, shares, method):
    """Return the mean of claims (P, ...) with shares (P, ...) that add up to 1."""
    if method == "log":
        return np.exp(np.sum(shares * np.log(claims), axis=0))
    return np.sum(shares * claims, axis=0)


def last_values(explanations):
    """Return the radiance of pixels after the last change."""
    return explanations.changes[-1].radiance if explanations.changes else explanations.mean


def everywhere(state):
    """Return the explanations of all pixels of a map."""
    y, x = np.indices(state.quality.shape).reshape(2, -1)
    return collect_claims(state, y, x, state.record.sensor_noise)


def chapel(channels, rng=4):
    """Return photos with pixels that are bright, dark, stuck, clipped or black in all of them."""
    E = scenes.chapel((96, 144))
    E = E if channels == 3 else colour.luminance(E)
    E = E.copy()
    E[40:48, 40:56] = 0
    times = camera.times_around(E, 5, stops=2)
    noisy = camera.Camera(full_well=8_000, read_noise=3, hot=2e-3)
    return camera.shoot(E, times, noisy, rng=rng)


def ball_bracket(channels):
    """Return photos of a wall with a ball that moves."""
    wall = np.broadcast_to(np.geomspace(0.2, 0.8, 160).astype(np.float32), (120, 160)).copy()
    ball = movers.ball((120, 160), (60, 60), 15, 2.0)
    taken = movers.shoot(wall, ball, movers.path(3, (0, 40)), [0.25, 0.5, 1.0]).bracket
    if channels == 1:
        return taken
    return replace(taken, images=np.repeat(taken.images[..., None], 3, axis=-1))


def floor_bracket(floor=13):
    """Return photos of a scanner that adds a black floor; the last two show more than the floor."""
    light = np.linspace(0.5, 1, 60 * 80).reshape(60, 80)
    times = np.array([1 / 64, 1 / 32, 1 / 16, 1 / 8, 4, 8, 16])
    images = [np.maximum(floor, 10 * light * t).astype(np.uint8) for t in times]
    return bracket(np.stack(images), times)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("channels", [1, 3])
def test_claims_and_shares_give_the_maps_value_again_for_every_merge(method, channels):
    state = pipeline.assemble(
        chapel(channels), align="none", merge=method, ghosts="none", response="auto"
    )
    explanations = everywhere(state)
    is_measured = explanations.shares.sum(axis=0) > 0
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = combine(explanations.claims, explanations.shares, method)
    np.testing.assert_allclose(
        explanations.mean[is_measured], mean[is_measured], rtol=FLOAT32_ROUNDING
    )
    np.testing.assert_allclose(
        last_values(explanations), explanations.E, rtol=FLOAT32_ROUNDING, atol=1e-12
    )
    kinds = {Quality(flag) for flag in np.unique(explanations.quality)}
    assert {Quality.MEASURED, Quality.CLIPPED, Quality.DARK, Quality.STUCK} <= kinds


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("channels", [1, 3])
@pytest.mark.parametrize("ghosts", ["regions", "reference"])
def test_where_something_moved_the_photos_that_were_used_give_the_maps_value_again(
    method, channels, ghosts
):
    state = pipeline.assemble(
        ball_bracket(channels), align="none", merge=method, ghosts=ghosts, times="stated"
    )
    explanations = everywhere(state)
    moved = (explanations.roles == Role.MOVED).any(axis=0)
    assert moved.any() and not moved.all()
    np.testing.assert_allclose(
        last_values(explanations), explanations.E, rtol=FLOAT32_ROUNDING, atol=1e-12
    )
    left_out = explanations.roles == Role.MOVED
    assert not explanations.shares[left_out].any()


def test_masked_photos_have_no_share_and_no_claim():
    taken = chapel(3)
    valid = np.ones(taken.images.shape[:3], bool)
    valid[1, :, :50] = False
    state = pipeline.assemble(replace(taken, valid=valid), align="none", ghosts="none")
    explanations = everywhere(state)
    is_masked = ~state.bracket.valid.reshape(len(valid), -1)
    assert np.array_equal(explanations.roles == Role.MASKED, is_masked)
    assert not explanations.shares[is_masked].any()
    np.testing.assert_allclose(
        last_values(explanations), explanations.E, rtol=FLOAT32_ROUNDING, atol=1e-12
    )
    assert state.why(10, 10).photos[1].claim == "–"


def test_claims_of_a_linear_camera_are_pixel_value_over_time_in_the_unit_of_the_map():
    levels = np.uint8([[[16, 100]], [[64, 255]]])
    images = np.tile(levels, (1, 24, 16))
    state = pipeline.assemble(
        bracket(images, [1, 4]), align="none", response="linear", times="stated"
    )
    dark = state.why(0, 0)
    bright = state.why(0, 1)
    # a linear response is 1 at the middle pixel value, 128
    assert [photo.luminance for photo in dark.photos] == pytest.approx([16 / 128, 16 / 128])
    assert bright.photos[0].luminance == pytest.approx(100 / 128)
    assert bright.photos[1].role == Role.CLIPPED
    first_clipped = int(0.98 * 255) + 1
    assert bright.photos[1].luminance == pytest.approx(first_clipped / 128 / 4)
    # Of shot noise, the share is weight times time.
    w = weights.gaussian()[[16, 64]]
    expected = w * [1, 4] / np.sum(w * [1, 4])
    assert [photo.share for photo in dark.photos] == pytest.approx(expected)
    assert bright.photos[0].share == 1
    for name, value in dark.alternatives.items():
        assert value == pytest.approx(16 / 128), name


def test_alternatives_are_the_maps_that_the_other_merges_make():
    taken = chapel(3)
    state = pipeline.assemble(taken, align="none", ghosts="none")
    y = 70
    x = 100
    for method in METHODS:
        other = pipeline.assemble(
            taken, align="none", ghosts="none", merge=method, response=lambda *a, **k: state.g
        )
        expected = colour.luminance(other.E)[y, x]
        assert state.why(y, x).alternatives[method] == pytest.approx(expected, rel=1e-5)


def test_the_sentence_names_the_photos_on_a_black_floor_and_what_the_others_say():
    state = pipeline.assemble(
        floor_bracket(), align="none", response="linear", times="stated", ghosts="none"
    )
    explanation = state.why(30, 40)
    assert [photo.role for photo in explanation.photos][:4] == [Role.FLOOR] * 4
    assert explanation.sentence.startswith("Four photos show only the black floor and give ")
    assert "three photos that measured" in explanation.sentence
    # the mean of all radiances believes the shortest photo most
    others = explanation.sentence.partition("Other merges would give: ")[2]
    assert f"mean {shorten(explanation.alternatives['mean'])}" in others


def test_dark_photos_that_follow_the_exposure_do_not_stand_on_a_floor():
    light = np.linspace(2, 3, 60 * 80).reshape(60, 80)
    times = 2.0 ** np.arange(6)
    images = np.stack([(light * t).astype(np.uint8) for t in times])
    state = pipeline.assemble(bracket(images, times), align="none", response="linear")
    roles = everywhere(state).roles
    assert not (roles == Role.FLOOR).any()


def test_a_photo_with_a_wrong_time_contradicts_the_map():
    light = np.linspace(6, 12, 60 * 80).reshape(60, 80)
    images = np.stack([light * t for t in (1, 2, 4, 8, 16)]).astype(np.uint8)
    state = pipeline.assemble(
        bracket(images, [1, 3.2, 4, 8, 16], names=["a", "wrong", "c", "d", "e"]),
        align="none",
        response="linear",
        times="stated",
        ghosts="none",
    )
    contrary = [photo.name for photo in state.why(5, 5).photos if photo.contradicts]
    assert contrary == ["wrong"]
    assert "; one other contradicts the map and gives " in state.why(5, 5).sentence


def test_a_pixel_that_is_clipped_everywhere_is_explained_by_its_bound():
    images = np.full((3, 40, 60), 255, np.uint8)
    images[:, :, :50] = np.array([40, 80, 160])[:, None, None]
    state = pipeline.assemble(bracket(images, [1, 2, 4]), align="none", response="linear")
    explanation = state.why(20, 55)
    assert explanation.quality == Quality.CLIPPED
    assert explanation.mean == explanation.radiance
    assert "no photo measured this pixel" in explanation.sentence
    assert [photo.share for photo in explanation.photos] == [0, 0, 0]


def test_the_deviation_of_a_pixel_is_that_of_the_map_with_its_uncertainty():
    state = pipeline.assemble(chapel(3), align="none", ghosts="none")
    sure = pipeline.measure_deviation(state)
    y, x = np.indices(state.quality.shape).reshape(2, -1)
    plain = collect_claims(state, y, x, state.sensor_noise)
    np.testing.assert_array_equal(plain.s, sure.s.reshape(len(y), -1))
    explanations = everywhere(sure)
    np.testing.assert_allclose(
        last_values(explanations), explanations.E, rtol=FLOAT32_ROUNDING, atol=1e-12
    )


def test_a_calibrated_map_is_explained_in_candela_per_square_meter():
    state = pipeline.assemble(chapel(3), align="none", ghosts="none")
    y, x = np.argwhere(state.quality == Quality.MEASURED)[500]
    in_candela = pipeline.calibrate(state, int(x), int(y), 250.0)
    explanation = in_candela.why(y, x)
    factor = in_candela.E[y, x] / state.E[y, x]
    assert explanation.luminance == pytest.approx(factor[1] * state.why(y, x).luminance, rel=1e-5)
    shares = [photo.shares for photo in explanation.photos]
    claims = [photo.radiance for photo in explanation.photos]
    assert np.sum(np.multiply(shares, claims), axis=0) == pytest.approx(explanation.mean, rel=1e-5)
    explanations = everywhere(in_candela)
    np.testing.assert_allclose(
        last_values(explanations), explanations.E, rtol=FLOAT32_ROUNDING, atol=1e-12
    )


def test_glare_that_was_removed_is_a_change_to_the_maps_value():
    state = pipeline.assemble(chapel(3), align="none", ghosts="none", flare="glare")
    explanations = everywhere(state)
    np.testing.assert_allclose(
        last_values(explanations), explanations.E, rtol=FLOAT32_ROUNDING, atol=1e-12
    )


def test_sixteen_bit_photos_are_explained_too():
    raw = camera.Camera(response="linear", bits=16, full_well=20_000)
    E = scenes.room((60, 90))
    state = pipeline.assemble(camera.shoot(E, [0.02, 0.08, 0.32], raw, rng=2), align="none")
    explanations = everywhere(state)
    np.testing.assert_allclose(
        last_values(explanations), explanations.E, rtol=FLOAT32_ROUNDING, atol=1e-12
    )
    assert explanations.levels.dtype == np.uint16


def test_a_stuck_pixel_at_the_border_has_the_median_of_its_neighbors():
    light = np.linspace(10, 20, 40 * 60).reshape(40, 60)
    images = np.stack([light, 2 * light, 4 * light]).astype(np.uint8)
    images[:, 0, 7] = 250
    state = pipeline.assemble(
        bracket(images, [1, 2, 4]), align="none", response="linear", times="stated"
    )
    explanation = state.why(0, 7)
    assert explanation.quality == Quality.STUCK
    text, radiance = explanation.changes[0]
    assert "median" in text and radiance == explanation.radiance
    assert text in explanation.sentence


def test_the_table_lists_every_photo_and_escapes_its_name():
    images = np.full((2, 24, 32), 100, np.uint8)
    images[1] = 200
    taken = bracket(images, [1, 2], names=["<b>one", "two"])
    explanation = pipeline.assemble(taken, align="none", response="linear").why(3, 4)
    text = str(explanation)
    assert "x 4, y 3" in text and "<b>one" in text and explanation.sentence in text
    page = explanation._repr_html_()
    assert "&lt;b&gt;one" in page and "<b>one" not in page


@pytest.mark.parametrize(("y", "x"), [(-1, 0), (0, -1), (24, 0), (0, 32)])
def test_a_pixel_outside_of_the_map_is_refused_with_the_maps_size(y, x):
    images = np.full((2, 24, 32), 100, np.uint8)
    images[1] = 200
    state = pipeline.assemble(bracket(images, [1, 2]), align="none", response="linear")
    with pytest.raises(InputError, match="32 x 24"):
        state.why(y, x)


def test_a_map_whose_photos_were_released_says_what_to_do():
    state = pipeline.assemble(chapel(3), align="none", ghosts="none", release=True)
    with pytest.raises(InputError, match="release"):
        state.why(3, 3)


def test_weights_are_those_of_the_lesson():
    taken = chapel(3)
    state = pipeline.assemble(taken, align="none", merge="log", weight="hat", ghosts="none")
    lesson = merge_with_quality(
        taken.images, state.bracket.times, state.g, weights.hat(), method="log", repair=False
    )
    explanations = everywhere(state)
    np.testing.assert_allclose(
        explanations.mean, lesson.E.reshape(explanations.mean.shape), rtol=FLOAT32_ROUNDING
    )
