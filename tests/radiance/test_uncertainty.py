"""hdrlab.radiance.uncertainty: the inverse-variance mean and the accuracy of its standard deviation."""

import numpy as np
import pytest

from hdrlab.capture import camera, responses
from hdrlab.radiance.merge import CLIPPING_LEVEL, METHODS, merge_with_quality
from hdrlab.radiance.uncertainty import inverse_variance_merge, merge_with_deviation, variance

WELL = 8_000
READ = 6.0
LIGHT = np.geomspace(1e-3, 10, 30_000).reshape(150, 200)


def photographed(response, bits=8, rng=0, E=LIGHT):
    """A bracket, its g, the electrons at level n / 2, and the radiance in the map's unit."""
    g = responses.true_g(response, 2**bits)
    times = camera.times_around(E, 6, stops=2)
    taken = camera.shoot(
        E,
        times,
        camera.Camera(response=response, bits=bits, full_well=WELL, read_noise=READ),
        rng=rng,
    )
    whole = np.exp(g[-1])  # exposure of a full well
    return taken.images, taken.times, g, WELL / whole, E * whole


@pytest.mark.parametrize(
    ("response", "bits"), [("linear", 16), ("linear", 8), ("gamma", 8), ("film", 8)]
)
def test_95_percent_of_pixels_in_each_decade_lie_within_1_96_deviations(response, bits):
    images, times, g, N, true = photographed(response, bits)
    merged = merge_with_deviation(images, times, g, N, READ)
    inside = np.abs(merged.E - true) < 1.96 * merged.s
    decade = np.floor(np.log10(LIGHT))
    shares = [
        inside[(decade == exponent) & np.isfinite(merged.s)].mean() for exponent in (-3, -2, -1, 0)
    ]
    assert np.allclose(shares, 0.95, atol=0.02), shares


def draws_near_clipping(relation, frame):
    """Return the errors z = (E - truth) / s of 20,000 draws near the clipping level, with five frames."""
    g = responses.true_g("linear", 256)
    whole = np.exp(g[-1])
    times = 4.0 ** np.arange(5)
    level = int(CLIPPING_LEVEL * 255) + 1
    E = relation * np.exp(g[level]) / whole / times[frame]
    sensor = camera.Camera(response="linear", bits=8, full_well=WELL, read_noise=READ)
    taken = camera.shoot(np.full((100, 200), E), times, sensor, rng=1)
    merged = merge_with_deviation(taken.images, taken.times, g, WELL / whole, READ)
    known = np.isfinite(merged.s)
    return (merged.E - E * whole)[known] / merged.s[known]


@pytest.mark.parametrize("relation", [0.96, 0.99, 1.005, 1.02])
def test_light_at_the_clip_level_of_the_shortest_frame_lies_within_1_96_deviations(relation):
    z = draws_near_clipping(relation, frame=0)
    assert z.size > 100
    assert np.mean(np.abs(z) < 1.96) > 0.94


@pytest.mark.parametrize("relation", [0.94, 0.97, 0.98, 0.99, 1.0, 1.01, 1.02])
@pytest.mark.parametrize("frame", [1, 2])
def test_the_clip_level_of_a_longer_frame_hardly_biases_the_mean(relation, frame):
    z = draws_near_clipping(relation, frame)
    assert z.size == 20_000
    assert np.mean(np.abs(z) < 1.96) == pytest.approx(0.95, abs=0.035)  # levels are 84 electrons
    assert abs(z.mean()) < 0.2  # 0.36 if a frame is judged by its own level


def test_the_deviation_of_light_in_the_middle_of_the_range_is_that_of_the_variances():
    g = responses.true_g("linear", 65536)
    images = np.full((1, 1, 1), 32_768, np.uint16)
    merged = merge_with_deviation(images, [1], g, N=1e4, R=5.0)
    V = variance(np.array(1.0), np.array(0.0), 1e4, 5.0)
    assert merged.s[0, 0] ** 2 == pytest.approx(float(V), rel=1e-3)


@pytest.mark.parametrize("response", ["linear", "gamma", "film"])
def test_the_inverse_variance_mean_has_the_smallest_error(response):
    images, times, g, N, true = photographed(response, rng=2)
    merged = merge_with_deviation(images, times, g, N, READ)
    known = np.isfinite(merged.s)

    def error(E):
        return np.sqrt(np.mean((E / true - 1)[known] ** 2))

    others = [error(merge_with_quality(images, times, g, method=name).E) for name in METHODS]
    assert error(merged.E) < min(others)


def test_the_reported_deviation_equals_that_of_repeated_draws():
    flat = np.full((40, 50), 0.05)
    images, times, g, N, _ = photographed("linear", 16, rng=1, E=flat)
    merged = merge_with_deviation(images, times, g, N, READ)
    assert merged.E.std() == pytest.approx(np.median(merged.s), rel=0.06)


def test_with_photon_noise_only_the_relative_error_is_one_over_the_root_of_the_count():
    g = responses.true_g("linear", 65536)
    images = np.full((3, 1, 1), 20_000, np.uint16) * np.array([1, 2, 3], np.uint16)[:, None, None]
    merged = merge_with_deviation(images, [1, 2, 3], g, N=1e4)
    counted = 1e4 * np.exp(g[images]).sum()
    assert merged.s / merged.E == pytest.approx(counted**-0.5, rel=1e-3)


def test_the_variance_of_a_mean_of_equal_estimates_is_divided_by_their_number():
    X = np.array([1.0, 2.0, 3.0])
    step = np.full(3, np.sqrt(12 * 0.3))
    E, s = inverse_variance_merge(X, step, np.ones(3, bool), np.ones(3), 1e12, 0)
    assert E == pytest.approx(2) and s**2 == pytest.approx(0.1)
    E, s = inverse_variance_merge(X, step, np.array([True, False, False]), [1, 1, 1], 1e12, 0)
    assert E == pytest.approx(1) and s**2 == pytest.approx(0.3)


def test_the_three_causes_of_noise_add_their_variances():
    X = np.array([0.0, 0.5, 2.0])
    assert variance(X, 0 * X, 100, 0) == pytest.approx(X / 100)
    assert variance(X, 0 * X, 100, 7) - X / 100 == pytest.approx(0.07**2)
    assert variance(0 * X, X, 1e9, 0) == pytest.approx(X**2 / 12)


def test_frame_order_does_not_matter_and_the_unit_of_time_scales_the_result():
    images, times, g, N, _ = photographed("film")
    merged = merge_with_deviation(images, times, g, N, READ)
    turned = merge_with_deviation(images[::-1], times[::-1], g, N, READ)
    slower = merge_with_deviation(images, 4 * times, g, N, READ)
    for expected, other, longer in zip(merged, turned, slower, strict=True):
        assert np.allclose(other, expected, rtol=1e-5)
        assert np.allclose(4 * longer, expected, rtol=1e-5)


@pytest.mark.parametrize("channels", [(), (3,)])
def test_pixels_that_no_frame_measures_have_a_bound_and_an_infinite_deviation(channels):
    images = np.array([[[40, 255, 0]], [[80, 255, 0]]], np.uint8)
    images = images.reshape(*images.shape, *[1] * len(channels)) + np.zeros(channels, np.uint8)
    g = responses.true_g("linear")
    merged = merge_with_deviation(images, [1, 2], g, 1000)
    assert merged.E.shape == merged.s.shape == images.shape[1:]
    assert merged.E.dtype == merged.s.dtype == np.float32
    assert np.isfinite(merged.s[0, 0]).all() and np.isinf(merged.s[0, 1:]).all()
    assert np.array_equal(merged.E[0, 1:], merge_with_quality(images, [1, 2], g).E[0, 1:])


def test_the_relative_error_rho_does_not_average_out():
    g = responses.true_g("linear", 65536)
    images = np.full((4, 1, 1), 30_000, np.uint16)
    merged = merge_with_deviation(images, np.ones(4), g, N=1e9, rho=0.02)
    assert merged.s / merged.E == pytest.approx(0.02, rel=1e-3)


@pytest.mark.parametrize(("R", "counts"), [(0.0, False), (30.0, True)])
def test_level_0_counts_as_measured_if_the_noise_exceeds_the_quantization_step(R, counts):
    images = np.array([[[0]], [[40]]], np.uint8)
    merged = merge_with_deviation(images, [1, 1], responses.true_g("linear"), N=1000, R=R)
    alone = merge_with_deviation(images[1:], [1], responses.true_g("linear"), N=1000, R=R)
    assert (merged.E < alone.E) == (merged.s < alone.s) == counts


def test_a_full_well_just_below_the_top_level_is_not_measured():
    # 0.8 % of the well
    maker = camera.Camera(response="linear", bits=16, full_well=2_500, read_noise=20)
    # the longer two are full
    taken = camera.shoot(np.full((200, 300), 1.5), [0.2, 1.0, 4.0], maker, rng=3)
    assert (taken.images[1:] < 0.98 * 65535).any()
    g = responses.true_g("linear", 65536)
    merged = merge_with_deviation(taken.images, taken.times, g, 2_500 / np.exp(g[-1]), 20)
    alone = merge_with_deviation(taken.images[:1], taken.times[:1], g, 2_500 / np.exp(g[-1]), 20)
    assert np.array_equal(merged.E, alone.E) and np.array_equal(merged.s, alone.s)


def test_each_channel_may_have_its_own_noise():
    images = np.array([[[[40, 40, 255]]], [[[80, 80, 255]]], [[[160, 160, 200]]]], np.uint8)
    g = responses.true_g("linear")
    merged = merge_with_deviation(images, [1, 2, 4], g, [100, 1000, 1000], [5, 0, 0])
    assert np.isfinite(merged.s).all() and merged.s[0, 0, 0] > 3 * merged.s[0, 0, 1]
    for c, knobs in enumerate([(100, 5), (1000, 0), (1000, 0)]):
        alone = merge_with_deviation(images[..., c], [1, 2, 4], g, *knobs)
        assert merged.E[0, 0, c] == alone.E[0, 0] and merged.s[0, 0, c] == alone.s[0, 0]


@pytest.mark.parametrize(
    "bad",
    [
        {"N": 0},
        {"N": -1},
        {"N": np.nan},
        {"N": np.inf},
        {"N": [1, 2, 3]},
        {"R": -1},
        {"R": np.nan},
        {"rho": -1},
    ],
)
def test_invalid_noise_raises_an_error(bad):
    with pytest.raises(ValueError, match=f"{next(iter(bad))} of at least .* .*channel"):
        merge_with_deviation(
            np.ones((2, 2, 2), np.uint8), [1, 2], responses.true_g("linear"), **{"N": 100, **bad}
        )
