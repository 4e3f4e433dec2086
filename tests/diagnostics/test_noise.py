"""hdrlab.diagnostics.noise: a camera's electrons, found in its own bracket."""

import numpy as np
import pytest

from hdrlab import scenes
from hdrlab.capture import camera, responses
from hdrlab.core import weights
from hdrlab.diagnostics.noise import estimate_noise, group_flat, scatter, slope
from hdrlab.errors import InputError
from hdrlab.fast.merge import merge_with_quality
from hdrlab.radiance.uncertainty import merge_with_deviation

pytestmark = pytest.mark.papers


@pytest.fixture(scope="module")
def room():
    return scenes.room((256, 384))


def shot(E, response="film", bits=8, well=8000, read=6.0, rng=1):
    """A bracket of five, its true g, and what fills the well."""
    g = responses.true_g(response, 2**bits)
    maker = camera.Camera(response=response, bits=bits, full_well=well, read_noise=read)
    taken = camera.shoot(E, camera.times_around(E, 5, stops=2), maker, rng=rng)
    return taken.images, taken.times, g, float(np.exp(g[-1]))


def merged(images, times, g):
    return merge_with_quality(images, times, g, weights.gaussian(len(g))).E


@pytest.mark.parametrize("well", [2_000, 8_000, 30_000])
@pytest.mark.parametrize(
    ("response", "bits"), [("linear", 16), ("gamma", 8), ("film", 8), ("srgb", 16)]
)
def test_full_well_capacity_is_estimated_within_8_percent_for_any_response(
    response, bits, well, room
):
    images, times, g, whole = shot(room[..., 1], response, bits, well)
    found = estimate_noise(images, times, g, merged(images, times, g))
    assert found.N * whole == pytest.approx(well, rel=0.08)


@pytest.mark.parametrize("read", [4.0, 8.0, 16.0])
def test_read_noise_is_estimated_within_12_percent(read, room):
    images, times, g, _ = shot(room[..., 1], "linear", 16, read=read)
    assert estimate_noise(images, times, g, merged(images, times, g)).R == pytest.approx(
        read, rel=0.12
    )


def test_a_wrong_response_raises_rho_and_not_the_photon_noise(room):
    images, times, g, whole = shot(room[..., 1], "linear", 16, well=40_000, read=3.0)
    wrong = 1.04 * g
    found = estimate_noise(images, times, wrong, merged(images, times, wrong))
    assert 0.02 < found.rho[0] < 0.1 and found.N * whole == pytest.approx(40_000, rel=0.3)
    assert estimate_noise(images, times, g, merged(images, times, g)).rho < 0.005


def test_noise_is_estimated_for_each_channel_separately(room):
    images, times, g, whole = shot(room, "gamma", well=10_000)
    few = shot(room, "gamma", well=2_500)[0]
    images[..., 2] = few[..., 2]
    found = estimate_noise(images, times, g, merged(images, times, g))
    assert found.N.shape == found.R.shape == found.rho.shape == (3,)
    assert found.N * whole == pytest.approx([10_000, 10_000, 2_500], rel=0.08)


@pytest.mark.parametrize("response", ["linear", "gamma", "film"])
def test_95_percent_of_pixels_lie_within_the_estimated_interval(response, room):
    images, times, g, whole = shot(room, response, well=5_000)
    found = merge_with_deviation(
        images, times, g, *estimate_noise(images, times, g, merged(images, times, g))
    )
    known = np.isfinite(found.s)
    assert np.mean((np.abs(found.E - whole * room) < 1.96 * found.s)[known]) == pytest.approx(
        0.95, abs=0.015
    )


def test_motion_in_a_corner_does_not_change_the_estimated_noise(room):
    images, times, g, whole = shot(room[..., 1], "gamma")
    images[2, -40:, -40:] = images[2, :40, :40]
    found = estimate_noise(images, times, g, merged(images, times, g))
    assert found.N * whole == pytest.approx(8_000, rel=0.1)


def test_a_wrong_exposure_time_raises_rho_and_not_the_photon_noise(room):
    images, times, g, whole = shot(room[..., 1], "gamma")
    times = times * np.array([1, 1, 1.15, 1, 1])
    found = estimate_noise(images, times, g, merged(images, times, g))
    assert found.N * whole == pytest.approx(8_000, rel=0.15) and 0.005 < found.rho[0] < 0.15


def test_the_order_of_the_photos_does_not_change_the_result(room):
    images, times, g, _ = shot(room[..., 1])
    E = merged(images, times, g)
    one, other = (
        estimate_noise(images, times, g, E),
        estimate_noise(images[::-1], times[::-1], g, E),
    )
    assert np.allclose(np.concatenate(one), np.concatenate(other), rtol=1e-3, atol=1e-5)


def test_a_bracket_without_enough_flat_pixels_raises_an_error():
    images, times, g, _ = shot(np.full((12, 12), 0.1, np.float32))
    with pytest.raises(ValueError, match="0 groups"):
        estimate_noise(images, times, g, np.full((12, 12), 0.1))
    with pytest.raises(ValueError, match=r"map of shape \(12, 12\)"):
        estimate_noise(images, times, g, np.ones((12, 13)))


def test_inputs_are_not_changed_and_invalid_radiance_raises_an_error(room):
    images, times, g, _ = shot(room[:128, :192, 1])
    E = merged(images, times, g)
    before = [np.copy(one) for one in (images, times, g, E)]
    found = estimate_noise(images, times, g, E)
    assert all(np.array_equal(*pair) for pair in zip(before, (images, times, g, E), strict=True))
    wide = np.asfortranarray(images), times, g, np.asfortranarray(E)
    assert np.array_equal(np.concatenate(found), np.concatenate(estimate_noise(*wide)))
    for bad in (np.nan, -1.0):
        E[0, 0] = bad
        with pytest.raises(InputError):
            estimate_noise(images, times, g, E)


def test_slope_ignores_the_pixel_itself():
    E = np.ones((9, 9))
    E[4, 4] = 3
    assert slope(E)[2, 2] == 0 and slope(E)[2, 0] == slope(E)[0, 2] == 2


def test_the_flattest_pixels_of_each_radiance_are_chosen():
    rng = np.random.default_rng(1)
    E, rough = rng.uniform(1, 100, 8_000), rng.uniform(0, 1, 8_000)
    groups = group_flat(E, rough)
    assert all(np.ptp(E[one]) < 5 and rough[one].max() < 0.6 for one in groups)
    assert len(np.concatenate(groups)) == pytest.approx(0.4 * 8_000, rel=0.03)


def test_scatter_ignores_outliers():
    y = np.random.default_rng(1).normal(5, 2, 20_000)
    assert scatter(y) == pytest.approx((4, 25), rel=0.03)
    y[:100] += 500
    assert scatter(y) == pytest.approx((4, 25), rel=0.05)
