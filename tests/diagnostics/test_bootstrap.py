"""hdrlab.diagnostics.bootstrap and residuals: the band, and what a response leaves unexplained."""

import numpy as np
import pytest

from hdrlab.capture import responses
from hdrlab.diagnostics import bootstrap, residuals
from hdrlab.diagnostics.bootstrap import Band, join_tiles, percentile_band, split_tiles
from hdrlab.fast import debevec
from hdrlab.response import linear

LINEAR = np.log(np.maximum(np.arange(256), 0.25) / 128)


def ramp(times, shape=(120, 160), factor=1.0, noise=0.0):
    """Return frames of a linear camera before an even ramp of light, 8 bits."""
    rng = np.random.default_rng(3)
    E = np.exp(rng.uniform(np.log(0.2), np.log(400), shape))
    X = E * np.asarray(times)[:, None, None] * np.reshape(factor, (-1, 1, 1))
    return np.clip(np.round(X + noise * rng.standard_normal(X.shape)), 0, 255).astype(np.uint8)


def test_tiles_laid_in_their_order_are_the_frames():
    stack = np.arange(2 * 7 * 9 * 3).reshape(2, 7, 9, 3)
    assert np.array_equal(join_tiles(split_tiles(stack, (3, 2)), (3, 2)), stack[:, :6, :8])
    assert split_tiles(stack, (3, 2)).shape == (6, 2, 2, 4, 3)


def test_a_tile_is_drawn_with_all_its_exposures_and_its_mask():
    """Every drawn pixel is one of the scene's, seen by all frames at once."""
    stack = (np.arange(48).reshape(6, 8) + np.array([0, 50, 100])[:, None, None]).astype(np.uint8)
    shown = stack < 140
    seen = []

    def recover(images, times, *, valid):
        assert np.array_equal(images[1], images[0] + 50) and np.array_equal(images[2], images[0] + 100)
        assert np.array_equal(valid, images < 140)
        seen.append(images)
        return LINEAR

    knobs = {"rounds": 20, "rng": 1, "tiles": (3, 4), "valid": shown}
    rounds = list(bootstrap.bootstrap_steps(recover, stack, [1, 2, 4], **knobs))
    assert len(rounds) == 20 and all(one.shape == stack.shape for one in seen)
    assert len({one.tobytes() for one in seen}) == 20


@pytest.mark.parametrize("name", ["srgb", "cubic", "gamma"])
def test_the_band_holds_the_true_response_and_is_no_wider_than_it_must_be(name, seven_frames):
    _, taken = seven_frames(name)
    found = bootstrap.bootstrap(debevec.recover, taken.images, taken.times, rounds=8, rng=1)
    true = responses.true_g(name)
    error = np.abs(found.middle.reshape(256, -1)[20:240] - true.reshape(256, -1)[20:240])
    assert np.all(found.low <= found.middle) and np.all(found.middle <= found.high)
    assert error.max() < 0.05 and 0 < found.width < 0.05
    assert np.all(found.low[128] == 0) and np.all(found.high[128] == 0)


def test_more_noise_makes_a_wider_band():
    times = [0.5, 1, 2]
    widths = [
        bootstrap.bootstrap(debevec.recover, ramp(times, (60, 80), noise=noise), times, rounds=6, rng=1).width
        for noise in (0.5, 12)
    ]
    assert widths[1] > 1.5 * widths[0]


def test_the_same_seed_gives_the_same_band_and_another_one_another():
    images, times = ramp([0.5, 1, 2], (60, 80)), [0.5, 1, 2]
    one, same, other = (
        bootstrap.bootstrap(debevec.recover, images, times, rounds=5, rng=seed) for seed in (1, 1, 2)
    )
    assert np.array_equal(one, same) and not np.array_equal(one, other)


def test_a_method_that_does_not_look_at_the_photographs_has_a_band_without_width():
    images = ramp([1, 2], (6, 8))
    found = bootstrap.bootstrap(linear.recover, images, [1, 2], rounds=3, rng=1)
    assert found.width == 0 and np.array_equal(found.low, found.high)


def test_the_band_lies_between_the_percentiles_of_the_rounds():
    found = percentile_band([LINEAR + k for k in range(101)], share=0.9)
    assert np.allclose(found.low, LINEAR + 5) and np.allclose(found.high, LINEAR + 95)
    assert np.isclose(Band(LINEAR, LINEAR, LINEAR + np.log(2)).width, 1)


def test_rounds_that_find_nothing_are_left_out_and_too_many_of_them_are_an_error():
    assert np.array_equal(percentile_band([LINEAR] * 9 + [None]).low, LINEAR)
    with pytest.raises(ValueError, match="3 of 10"):
        percentile_band([LINEAR] * 3 + [None] * 7)


@pytest.mark.parametrize("knobs", [{"rounds": 1}, {"tiles": (0, 3)}, {"share": 1.0}])
def test_knobs_out_of_range_are_refused(knobs):
    with pytest.raises(ValueError, match="expected"):
        bootstrap.bootstrap(linear.recover, ramp([1, 2], (6, 8)), [1, 2], **{"rounds": 2} | knobs)


def test_photographs_that_hold_nothing_are_refused():
    dark = np.zeros((2, 24, 32), np.uint8)
    with pytest.raises(ValueError, match="0 of 4"):
        bootstrap.bootstrap(debevec.recover, dark, [1, 2], rounds=4, rng=1)


def test_the_inputs_are_not_changed():
    images, times = ramp([0.5, 1, 2], (60, 80)), np.array([0.5, 1, 2])
    before = images.copy()
    bootstrap.bootstrap(debevec.recover, images, times, rounds=3, rng=1)
    residuals.residuals(images, times, LINEAR)
    assert np.array_equal(images, before) and times.tolist() == [0.5, 1, 2]


def test_the_true_response_and_times_leave_nothing_but_rounding():
    times = [0.25, 0.5, 1, 2]
    r = residuals.residuals(ramp(times, (300, 400)), times, LINEAR)
    assert r.shape == (4, 256) and residuals.rms(r) < 0.02
    assert np.nanmax(np.abs(r[:, 40:200])) < 0.03


def test_a_frame_with_a_wrong_time_lies_off_by_as_much():
    """A frame 0.3 stops brighter than it says; the three others share what it pulls at lE."""
    times = [0.25, 0.5, 1, 2]
    images = ramp(times, (300, 400), factor=[1, 2**0.3, 1, 1])
    off = residuals.frame_offsets(residuals.residuals(images, times, LINEAR))
    assert np.isclose(off[1] - off[[0, 2, 3]].mean(), 0.3, atol=0.1)
    assert np.argmax(np.abs(off)) == 1


def test_a_wrong_response_bends_the_residuals_of_all_frames_over_the_levels():
    times = [0.25, 0.5, 1, 2]
    images = ramp(times, (300, 400))
    wrong = residuals.residuals(images, times, 1.3 * LINEAR)
    assert residuals.rms(wrong) > 5 * residuals.rms(residuals.residuals(images, times, LINEAR))


def test_levels_of_few_samples_and_of_no_weight_are_not_known():
    times = [1, 2]
    r = residuals.residuals(ramp(times, (200, 200)), times, LINEAR)
    assert np.isnan(r[:, [0, 251, 255]]).all() and np.isfinite(r).any()
    assert np.isnan(residuals.residuals(ramp(times, (3, 3)), times, LINEAR)).all()
    assert np.isnan(residuals.rms(np.full((2, 256), np.nan)))
    assert np.isnan(residuals.frame_offsets(np.full((2, 256), np.nan))).all()


def test_a_sample_that_one_frame_sees_well_says_nothing():
    images = np.stack([np.full((20, 20), 200, np.uint8), np.full((20, 20), 255, np.uint8)])
    assert np.isnan(residuals.residuals(images, [1, 2], LINEAR)).all()
    images[1] = 100
    assert np.isfinite(residuals.residuals(images, [1, 2], LINEAR)[[0, 1], [200, 100]]).all()


def test_colour_is_looked_at_channel_by_channel():
    times = [0.25, 0.5, 1, 2]
    gray = ramp(times, (300, 400))
    rgb = np.stack([gray] * 3, axis=-1)
    g = np.stack([LINEAR, 1.3 * LINEAR, LINEAR], axis=-1)
    r = residuals.residuals(rgb, times, g)
    assert r.shape == (4, 256, 3) and np.allclose(r[..., 0], r[..., 2], equal_nan=True)
    assert np.allclose(r[..., 0], residuals.residuals(gray, times, LINEAR), equal_nan=True)
    assert residuals.rms(r[..., 1]) > 5 * residuals.rms(r[..., 0])
    with pytest.raises(ValueError, match=r"response \(n,\) for gray"):
        residuals.residuals(gray, times, g)
