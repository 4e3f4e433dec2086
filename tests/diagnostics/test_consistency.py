"""The map against its photographs: true brackets agree with themselves, wrong times are found and named."""

import numpy as np
import pytest

from hdrlab.capture import camera, responses
from hdrlab.core.weights import gaussian
from hdrlab.diagnostics import consistency
from hdrlab.fast.merge import merge

G = responses.true_g("film")


@pytest.fixture(scope="module")
def bracket(decades):
    """Five clean frames two stops apart, 16 bits, gray."""
    E = decades((300, 300))
    return E, camera.shoot(E, camera.times_around(E, 5, stops=2), camera.Camera(bits=16))


def medians(taken, times, g=G):
    """Return the level medians of the map that these times make."""
    E = merge(taken.images, times, g, gaussian(65536 if taken.images.dtype == np.uint16 else 256))
    return consistency.measure_level_exposures(taken.images, times, E)


def test_a_bracket_without_noise_has_no_spread(bracket):
    E, taken = bracket
    true = consistency.measure_level_exposures(taken.images, taken.times, E)
    # what is left are the medians of some hundred pixels
    assert consistency.measure_spread(true) < 0.003
    assert consistency.measure_spread(medians(taken, taken.times)) < 0.003


def test_the_medians_are_the_response_in_stops(bracket):
    E, taken = bracket
    found = np.nanmean(
        consistency.measure_level_exposures(taken.images, taken.times, E)[:, 0, 30:226], axis=0
    )
    expected = G[30:226] / np.log(2)
    assert np.allclose(found - found[98], expected - expected[98], atol=0.02)  # level 128


def test_the_spread_grows_with_the_error_of_a_time(bracket):
    _, taken = bracket
    spreads = []
    for stops in (0, 0.1, 0.3, 1):
        times = taken.times.copy()
        times[2] *= 2**stops
        spreads.append(consistency.measure_spread(medians(taken, times)))
    assert np.all(np.diff(spreads) > 0.01) and spreads[-1] > 0.2


def test_a_channel_that_the_spread_hides_shows_in_the_rms_spread():
    medians = np.zeros((4, 3, 256))
    medians[2, 2] = 1  # one photo is a stop off in blue
    assert consistency.measure_spread(medians) == 0
    assert consistency.measure_rms_spread(medians) == pytest.approx(0.25)  # 0.433 / sqrt(3)


@pytest.mark.parametrize("frame", range(5))
@pytest.mark.parametrize("stops", [-0.7, 0.7])
def test_a_wrong_exposure_time_shows_as_a_deviation_of_its_frame_and_at_most_its_neighbours(
    bracket, frame, stops
):
    _, taken = bracket
    times = taken.times.copy()
    times[frame] *= 2**stops
    apart = consistency.measure_deviations(medians(taken, times))
    named = np.flatnonzero(np.abs(apart) > 0.1)
    assert frame in named and np.sign(apart[frame]) == np.sign(stops)
    # a neighbour, which the map draws to the other side
    assert set(named) <= {
        frame - 1,
        frame,
        frame + 1,
    }
    assert np.all(np.abs(consistency.measure_deviations(medians(taken, taken.times))) < 0.01)


def test_a_wrong_response_shows_where_the_frames_are_merged(bracket):
    _, taken = bracket
    assert consistency.measure_spread(medians(taken, taken.times, responses.true_g("linear"))) > 0.1


def test_the_unit_of_the_map_does_not_matter(bracket):
    E, taken = bracket
    one, other = (
        consistency.measure_level_exposures(taken.images, taken.times, k * E) for k in (1, 1000)
    )
    assert np.isclose(consistency.measure_spread(one), consistency.measure_spread(other), atol=1e-5)
    assert np.allclose(
        consistency.measure_deviations(one), consistency.measure_deviations(other), atol=1e-5
    )


@pytest.mark.parametrize("channels", [(), (3,)])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_there_is_a_median_per_frame_channel_and_level_of_256(channels, dtype):
    images = np.full((2, 20, 30, *channels), 100, dtype) * (257 if dtype == np.uint16 else 1)
    E = np.full(images.shape[1:], 4, np.float32)
    found = consistency.measure_level_exposures(images, [1, 2], E)
    assert found.shape == (2, 3 if channels else 1, 256)
    assert np.all(found[0, :, 100] == 2) and np.all(found[1, :, 100] == 3)
    assert np.isnan(found).sum() == found.size - found[..., 100].size
    assert consistency.measure_spread(np.where(np.arange(256) < 30, np.nan, found)) == 0.5


def test_a_level_counts_with_enough_pixels_that_are_not_clipped_in_any_channel():
    images = np.full((2, 10, 10, 3), 100, np.uint8)
    images[1, :6, :, 0] = 255
    found = consistency.measure_level_exposures(images, [1, 2], np.ones((10, 10, 3)))
    assert np.isfinite(found[0, :, 100]).all() and np.isnan(found[1]).all()  # 40 pixels are too few


def test_pixels_that_a_frame_does_not_show_and_pixels_of_0_are_left_out():
    images = np.full((2, 20, 20), 100, np.uint8)
    E = np.ones((20, 20))
    E[:5] = 0
    valid = np.ones(images.shape, bool)
    images[1, 5:10], valid[1, 5:10] = 180, False
    found = consistency.measure_level_exposures(images, [1, 2], E, valid=valid)
    assert found[0, 0, 100] == 0 and found[1, 0, 100] == 1 and np.isnan(found[1, 0, 180])
    assert np.isfinite(consistency.measure_level_exposures(images, [1, 2], E)[1, 0, 180])


def test_spread_and_deviations_are_nan_if_frames_share_no_level():
    images = np.stack([np.full((10, 10), z, np.uint8) for z in (60, 200)])
    found = consistency.measure_level_exposures(images, [1, 4], np.ones((10, 10)))
    assert (
        np.isnan(consistency.measure_spread(found))
        and np.isnan(consistency.measure_deviations(found)).all()
    )


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"E": np.ones((4, 6))}, r"map of shape \(4, 5\), got \(4, 6\)"),
        ({"E": -np.ones((4, 5))}, "20 negative"),
        ({"times": [1]}, "expected 2 exposure times"),
        ({"valid": np.ones((4, 5))}, r"mask of shape \(2, 4, 5\)"),
    ],
)
def test_arrays_that_do_not_fit_together_raise_an_error(given, said):
    knobs = {"images": np.zeros((2, 4, 5), np.uint8), "times": [1, 2], "E": np.ones((4, 5))} | given
    with pytest.raises(ValueError, match=said):
        consistency.measure_level_exposures(**knobs)


def test_the_true_response_and_times_leave_no_residual(bracket):
    E, taken = bracket
    r = consistency.measure_residuals(
        consistency.measure_level_exposures(taken.images, taken.times, E), G
    )
    r -= np.nanmedian(r)  # E is in a unit of its own
    assert r.shape == (5, 1, 256) and np.nanmax(np.abs(r[..., 20:230])) < 0.02


def test_a_wrong_response_bends_the_residuals_of_all_frames_equally(bracket):
    _, taken = bracket
    E = merge(taken.images, taken.times, G, gaussian(65536))
    found = consistency.measure_level_exposures(taken.images, taken.times, E)
    right, wrong = (consistency.measure_residuals(found, g)[..., 20:230] for g in (G, 1.3 * G))
    assert np.nanstd(wrong) > 10 * np.nanstd(right)
    assert np.nanstd(wrong - np.nanmean(wrong, axis=0)) < 0.1 * np.nanstd(wrong)


def test_a_frame_with_a_wrong_time_leaves_a_residual_at_all_its_levels(bracket):
    _, taken = bracket
    # the middle frame saw longer than it says
    times = taken.times * np.array([1, 1, 2**-0.5, 1, 1])
    off = np.nanmedian(
        consistency.measure_residuals(medians(taken, times), G)[..., 30:226], axis=(1, 2)
    )
    assert np.argmax(off) == 2 and off[2] - np.delete(off, 2).mean() > 0.2


def test_residuals_require_a_response_with_the_same_channels():
    with pytest.raises(ValueError, match="response"):
        consistency.measure_residuals(np.zeros((3, 1, 256)), np.stack([G] * 3, axis=1))
