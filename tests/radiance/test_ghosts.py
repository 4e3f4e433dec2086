"""Ghosts: moving objects are found and appear once; static regions do not change."""

import dataclasses

import numpy as np
import pytest

from hdrlab.capture import camera, movers
from hdrlab.capture.responses import true_g
from hdrlab.core import weights
from hdrlab.errors import InputError
from hdrlab.radiance.deghosting import deviation, frames, ghosts, reference, regions
from hdrlab.radiance.merge import Quality, merge_with_quality
from hdrlab.response import linear

FILM = true_g("film")
W = weights.gaussian()
LINEAR = linear.curve()
SHAPE = (90, 140)


@pytest.fixture(scope="module")
def wall():
    """A wall of soft light with a dark door: an edge of high contrast."""
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]]
    light = (0.4 + 0.3 * np.sin(x / 17) * np.cos(y / 23)).astype(np.float32)
    light[30:, 100:125] /= 40
    return np.stack([light, 0.9 * light, 0.7 * light], axis=-1)


@pytest.fixture(scope="module")
def moving(wall):
    ball = movers.ball(SHAPE, (45, 60), 9, [3.0, 1.0, 0.4])
    at = movers.path(5, (4, 14))
    return movers.shoot(
        wall,
        ball,
        at,
        camera.times_around(wall, 5),
        camera.Camera(full_well=50_000, read_noise=5),
        rng=2,
    )


def found_in(taken, valid=None, merged=None, **knobs):
    """Return the map of a bracket without ghosts, merged with the film's own response."""
    return ghosts.remove_ghosts(
        taken.images, taken.times, FILM, W, valid=valid, merged=merged, **knobs
    )


def rms(E, truth, where):
    """Return the root mean square of log2(E / truth) in a region, after dividing by the median ratio."""
    ratio = np.log2(E / truth)
    return float(np.sqrt(np.mean((ratio[where] - np.median(ratio)) ** 2)))


# What the equations say


def test_deviation_is_the_weighted_variance_of_the_frames_estimates():
    rng = np.random.default_rng(1)
    images = rng.integers(1, 240, (4, 6, 7), np.uint8)
    times = np.array([1.0, 2, 4, 8])
    taken = frames.calibrate_frames(images, times, LINEAR, np.ones((6, 7)))
    x = LINEAR[images] - np.log(times)[:, None, None]
    w = W[images]
    mean = (w * x).sum(axis=0) / w.sum(axis=0)
    expected = (w * (x - mean) ** 2).sum(axis=0) / w.sum(axis=0)
    assert np.allclose(deviation.measure_deviation(taken, W).v, expected, rtol=1e-3, atol=1e-5)


def test_frames_that_agree_have_no_deviation_and_the_unit_of_light_does_not_matter():
    images = np.array([[[30, 60]], [[60, 120]], [[120, 240]]], np.uint8)
    for unit in (1, 1e-4, 1e5):
        taken = frames.calibrate_frames(
            images, unit * np.array([1.0, 2, 4]), LINEAR, np.ones((1, 2))
        )
        assert np.allclose(deviation.measure_deviation(taken, np.ones(256)).v, 0, atol=1e-5)


def test_a_sharp_edge_misaligned_by_a_pixel_is_not_a_ghost(wall):
    times = camera.times_around(wall, 5)
    offsets = np.array([[0, 0], [0, 1], [1, 0], [1, 1], [0, 1]])
    images = [
        camera.shoot(E, [t]).images[0]
        for E, t in zip(camera.views(wall, offsets), times, strict=True)
    ]
    E = merge_with_quality(images, times, FILM, W).E
    plain = deviation.measure_deviation(frames.calibrate_frames(images, times, FILM, E), W)
    assert np.sqrt(plain.v).max() > 0.5  # the door's edge is as contradictory as any ghost
    assert deviation.score_contradiction(plain, tau=ghosts.LOG_TOLERANCE, edge=0).max() > 3
    assert deviation.score_contradiction(plain, tau=ghosts.LOG_TOLERANCE, edge=0.5).max() < 1.1
    score = deviation.score_contradiction(
        plain, tau=ghosts.LOG_TOLERANCE, edge=ghosts.EDGE_FRACTION
    )
    assert not regions.find_seeds(score).any()


def test_regions_grow_only_from_their_seeds():
    seed, weak = np.zeros((2, 9, 30), bool)
    seed[4, 2] = True
    weak[4, :12] = True
    weak[4, 20:] = True
    grown = regions.grow(seed, weak, 20)
    assert grown[4, :12].all() and not grown[:, 12:].any()
    assert regions.grow(seed, weak, 3)[4].nonzero()[0].max() == 5


def test_holes_in_a_region_are_filled():
    ring = np.zeros((20, 20), bool)
    ring[5:15, 5:15] = True
    ring[8:12, 8:12] = False
    assert regions.dilate(ring, 0)[5:15, 5:15].all()
    assert not regions.dilate(np.zeros((5, 5), bool), 3).any()


def test_blending_is_linear_in_stops():
    E = np.full((1, 3), 1.0, np.float32)
    other = np.full((1, 3), 16.0, np.float32)
    assert np.allclose(regions.blend(E, other, np.array([[0, 0.5, 1]])), [[1, 4, 16]])


def test_the_best_exposure_of_a_region_is_the_longest_that_measures_it():
    images = np.array([10, 60, 200, 255], np.uint8)[:, None, None] * np.ones((1, 40, 40), np.uint8)
    taken = frames.calibrate_frames(images, [1, 4, 12, 64], LINEAR, np.full((40, 40), 0.1))
    assert frames.best_exposures(taken, np.ones((40, 40), np.int32)).tolist() == [2]


def test_a_reference_is_not_clipped_where_other_photos_are_darker():
    """A lamp that moved is bright only in the long frame, which gives no more than a bound there."""
    images = np.array([20, 80], np.uint8)[:, None, None] * np.ones((1, 40, 40), np.uint8)
    images[1, :, :10] = 255
    taken = frames.calibrate_frames(images, [1, 4], LINEAR, np.full((40, 40), 20 / 128))
    assert frames.best_exposures(taken, np.ones((40, 40), np.int32)).tolist() == [0]


def test_a_pixel_with_one_clipped_channel_is_not_well_exposed():
    images = np.full((2, 40, 40, 3), 60, np.uint8)
    images[1] = 240
    images[1, ..., 0] = 255
    E = np.full((40, 40, 3), 60 / 128)
    taken = frames.calibrate_frames(images, [1, 4], LINEAR, E)
    assert frames.best_exposures(taken, np.ones((40, 40), np.int32)).tolist() == [0]


def test_a_slightly_wrong_exposure_time_is_not_motion(moving, wall):
    still = camera.shoot(wall, moving.bracket.times, camera.Camera(full_well=50_000), rng=3)
    wrong = still.times * [1, 1.15, 1, 0.87, 1]
    assert not ghosts.remove_ghosts(still.images, wrong, FILM, W).labels.any()


def test_a_frame_is_used_where_it_and_its_neighborhood_agree_with_the_reference():
    images = np.full((2, 30, 40), 50, np.uint8)
    images[1] = 100
    images[1, 10:20, 10:20] = 200
    taken = frames.calibrate_frames(images, [1, 2], LINEAR, np.full((30, 40), 50 / 128))
    used = reference.find_consistent_frames(taken, 0, (slice(None), slice(None)))
    assert used[0].all()
    assert not used[1, 8:22, 8:22].any()
    assert used[1, :4].all()
    assert used[1, :, 30:].all()


def test_a_frame_is_not_used_where_it_contradicts_the_bound_of_a_clipped_reference():
    images = np.full((2, 30, 40), 255, np.uint8)
    images[0] = 200  # bright, as the leader's bound asks for
    images[0, :, 20:] = 5  # somebody dark, where the leader says "at least"
    taken = frames.calibrate_frames(images, [1, 4], LINEAR, np.full((30, 40), 1.5))
    used = reference.find_consistent_frames(taken, 1, (slice(None), slice(None)))
    assert used[0, :, :14].all() and not used[0, :, 24:].any()


def test_a_difference_in_the_dark_beside_a_noisy_light_is_found():
    dark = np.full((40, 40, 1), 1e-3, np.float32)
    everywhere = np.ones((40, 40, 1), bool)
    V = np.full((40, 40, 1), 1e-12, np.float32)
    V[:, :20, 0] = np.exp(np.random.default_rng(2).normal(0, 8, (40, 20)))
    known = reference.Estimate(dark, V, everywhere, np.zeros_like(V), np.full_like(V, np.inf))
    other = dataclasses.replace(known, E=np.where(np.arange(40)[:, None] < 20, dark, 3 * dark))
    agree = reference.find_consistent(known, other, tau=0.05)
    assert agree[:, :15].all() and not agree[:, 25:].any()


# What becomes of a ghost


def test_the_error_in_moving_regions_is_ten_times_smaller_and_others_are_not_changed(moving):
    b = moving.bracket
    plain = merge_with_quality(b.images, b.times, FILM, W)
    for knobs in ({}, {"fixed": 2}):
        result = found_in(b, **knobs)
        truth = moving.still.copy()
        for r, j in enumerate(result.references, start=1):
            truth[result.labels == r] = moving.moments[j][result.labels == r]
        where = moving.region & (result.labels > 0) & (result.quality == Quality.MEASURED)
        assert where.sum() > 0.5 * moving.region.sum()
        candidates = (truth, moving.still, *moving.moments)
        assert 10 * rms(result.E, truth, where) < min(
            rms(plain.E, candidate, where) for candidate in candidates
        )
        outside = result.labels == 0
        assert np.array_equal(result.E[outside], plain.E[outside])
        assert np.array_equal(result.quality[outside], plain.quality[outside])
        assert result.used[:, outside].all()


def test_a_figure_seen_in_the_only_unclipped_frame_is_found_as_one_region():
    """The sky is clipped in the longer frames; the wall below is measured in all of them."""
    sky = np.where(np.arange(90)[:, None] < 50, 100.0, 2.0) * np.ones((1, 140))
    ball = movers.ball(SHAPE, (50, 70), 15, 8.0, stripes=0)
    times = [0.004, 0.03, 0.12, 0.5]
    images = camera.shoot(sky, times, camera.Camera(response="film"), rng=1).images.copy()
    seen, _ = movers.compose_moment(np.float32(sky), ball, (0, 0))
    images[0] = camera.shoot(seen, times, camera.Camera(response="film"), rng=1).images[0]
    result = ghosts.remove_ghosts(images, times, FILM, W)
    whole = ball.mask > 0.5
    assert result.labels.max() == 1 and np.all(result.labels[whole] == 1)
    upper = np.median(np.log2(result.E / seen)[whole & (sky > 50)])
    lower = np.median(np.log2(result.E / seen)[whole & (sky < 50)])
    assert abs(upper - lower) < 0.3
    still = camera.shoot(sky, times, camera.Camera(response="film"), rng=1).images
    assert ghosts.remove_ghosts(still, times, FILM, W).labels.max() == 0


def test_with_a_fixed_reference_the_map_shows_its_moment(moving):
    for j in range(5):
        result = found_in(moving.bracket, fixed=j)
        assert set(result.references.tolist()) == {j}
        inside = result.labels > 0
        assert result.used[j, inside].all()
        Z = moving.bracket.images[j][moving.hidden[j]]
        # the figure is no burnt-out one, which the merge leaves out
        if np.mean(Z.max(axis=-1) < 250) > 0.5:
            assert inside[moving.hidden[j]].mean() > 0.9


def test_alone_uses_one_frame_in_each_region(moving):
    result = found_in(moving.bracket, alone=True)
    inside = result.labels > 0
    assert inside.any() and np.all(result.used.sum(axis=0)[inside] == 1)


def test_any_order_of_frames_gives_the_same_map(moving):
    b = moving.bracket
    order = [3, 0, 4, 1, 2]
    first = found_in(b)
    other = ghosts.remove_ghosts(b.images[order], b.times[order], FILM, W)
    assert np.array_equal(first.labels, other.labels) and np.allclose(first.E, other.E, rtol=1e-5)
    assert np.array_equal(np.array(order)[other.references], first.references)
    assert np.array_equal(first.used[order], other.used)


def test_gray_and_16_bit_brackets_give_the_same_regions(moving):
    b = moving.bracket
    eight = found_in(b)
    sixteen = ghosts.remove_ghosts(b.images.astype(np.uint16) * 257, b.times, FILM, W)
    gray = ghosts.remove_ghosts(b.images[..., 0], b.times, FILM, W)
    assert (eight.labels > 0)[sixteen.labels > 0].mean() > 0.9
    assert gray.E.shape == SHAPE and (eight.labels > 0)[gray.labels > 0].mean() > 0.5


def test_masked_pixels_are_not_used(moving):
    b = moving.bracket
    valid = np.ones(b.images.shape[:3], bool)
    valid[:, :, :6] = False
    valid[1] = False
    result = found_in(b, valid=valid)
    assert not result.used[~valid].any() and 1 not in result.references
    assert np.all(result.quality[:, :6] == Quality.UNSEEN) and np.all(np.isfinite(result.E))


def test_remove_ghosts_does_not_change_its_arguments(moving):
    b = moving.bracket
    merged = merge_with_quality(b.images, b.times, FILM, W)
    before = merged.E.copy(), merged.quality.copy(), b.images.copy()
    found_in(b, merged=merged)
    for copy, array in zip(before, (merged.E, merged.quality, b.images), strict=True):
        assert np.array_equal(copy, array)


# Static scenes


def test_a_still_scene_has_no_moving_region_and_the_plain_map(wall):
    for bits, seed in ((8, 1), (16, 2)):
        still = camera.shoot(
            wall, camera.times_around(wall, 5), camera.Camera(bits=bits, full_well=20_000), rng=seed
        )
        g = true_g("film", 2**bits)
        w = weights.gaussian(2**bits)
        result = ghosts.remove_ghosts(still.images, still.times, g, w)
        assert not result.labels.any() and len(result.references) == 0
        assert np.array_equal(result.E, merge_with_quality(still.images, still.times, g, w).E)


def test_what_all_photos_agree_on_within_a_region_stays_the_plain_map(moving, wall):
    b = moving.bracket
    plain = merge_with_quality(b.images, b.times, FILM, W)
    result = found_in(b)
    inside = result.labels > 0
    same = inside & result.used.all(axis=0)
    assert same.any() and np.allclose(result.E[same], plain.E[same], rtol=1e-5)


@pytest.mark.parametrize("level", [0, 255])
def test_black_and_white_brackets_have_no_ghosts(level):
    result = ghosts.remove_ghosts(np.full((3, 20, 30, 3), level, np.uint8), [1, 2, 4], FILM)
    assert not result.labels.any() and np.all(np.isfinite(result.E))


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"fixed": 5}, "number of a frame"),
        ({"valid": np.ones((2, 2))}, "mask of shape"),
    ],
)
def test_invalid_arguments_raise_an_error(moving, wrong, message):
    with pytest.raises(ValueError, match=message):
        found_in(moving.bracket, **wrong)


def test_the_note_names_the_regions_and_their_reference_frames(moving, wall):
    names = [f"img{j}" for j in range(5)]
    result = found_in(moving.bracket)
    note = ghosts.note(result, names)
    assert "region" in note and all(names[j] in note for j in result.references)
    still = camera.shoot(wall, moving.bracket.times)
    assert "nothing moved" in ghosts.note(found_in(still), names)


def test_the_note_questions_widespread_motion(moving):
    b = moving.bracket
    noise = np.random.default_rng(4).integers(1, 249, b.images.shape, np.uint8)
    noise = np.repeat(np.repeat(noise[:, ::9, ::9], 9, axis=1), 9, axis=2)[
        :, : SHAPE[0], : SHAPE[1]
    ]
    result = ghosts.remove_ghosts(noise, b.times, FILM, W)
    assert "alignment" in ghosts.note(result, [f"img{j}" for j in range(5)])


def test_the_mask_grows_from_clear_motion_into_textured_parts():
    v = np.zeros((40, 60), np.float32)
    r = np.zeros((40, 60), np.float32)
    v[15:25, 10:20] = 1.0  # a head, which contradicts clearly
    # a striped coat
    v[15:25, 20:30] = 0.15**2
    r[15:25, 20:30] = 0.5
    textured = deviation.Deviation(v, np.zeros_like(v), r)
    score, mask = ghosts.detect_motion(textured, tau=0.1, edge=0.35, margin=3)
    assert (score[15:25, 20:30] < 1).all() and mask[15:25, 10:30].all()
    beside = deviation.Deviation(np.where(r > 0, v, 0), textured.s2, r)
    assert not ghosts.detect_motion(beside, tau=0.1, edge=0.35, margin=3)[1].any()


def test_a_black_pixel_is_at_most_level_1_and_a_full_one_at_least_the_first_clipped_level():
    images = np.array([[[0, 100, 255]], [[0, 200, 255]]], np.uint8)
    E = np.full((1, 3), 100 / 128, np.float32)
    g = np.log(np.maximum(np.arange(256), 0.5) / 128)
    taken = frames.calibrate_frames(images, [1, 2], g, E)
    frame = reference.read_frame(taken, 1, np.s_[:, :])
    assert frame.high[0, 0, 0] == pytest.approx(np.exp(taken.x[1, 0, 1]))
    assert frame.high[0, 1, 0] == np.inf
    assert frame.low[0, 2, 0] == pytest.approx(np.exp(taken.x[1, 0, taken.top]))
    assert frame.low[0, 1, 0] == 0
    assert frame.measured[0, :, 0].tolist() == [False, True, False]


def test_contradictions_of_clipped_frames_are_found_except_at_misaligned_edges():
    E = np.zeros((9, 11, 3), np.float32)
    near = np.zeros((9, 11, 3), bool)
    outside = np.zeros((9, 11, 3), bool)
    E[4, 5] = 1.0
    near[3:6, 4:7] = True
    outside[:, -2:] = True
    clipped = np.full((1, *E.shape), 255, np.uint8)
    taken = frames.Calibrated(
        clipped, np.ones(1), 255, None, np.zeros((1, 3, 256)), np.ones((1, 3, 256))
    )
    assert np.array_equal(deviation.find_clipped_elsewhere(taken, E), ~near[..., 0])
    seen = dataclasses.replace(taken, valid=~outside[None, ..., 0])
    assert np.array_equal(deviation.find_clipped_elsewhere(seen, E), ~(near | outside)[..., 0])


@pytest.mark.parametrize("w", [np.zeros(256), -np.ones(256), np.ones((256, 3))])
def test_invalid_weights_raise_an_error(moving, w):
    images = moving.bracket.images
    times = moving.bracket.times
    E = merge_with_quality(images, times, FILM).E
    taken = frames.calibrate_frames(images, times, FILM, E)
    with pytest.raises(InputError, match="weights"):
        deviation.measure_deviation(taken, w)


def test_a_map_of_another_size_than_the_photos_raises_an_error(moving):
    images = moving.bracket.images
    times = moving.bracket.times
    with pytest.raises(InputError, match="shape"):
        frames.calibrate_frames(images, times, FILM, np.ones((4, 5, 3)))
