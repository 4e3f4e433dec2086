"""The simulated camera: closed forms of its output for a known scene."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from hdrlab.capture import camera, responses, sensor
from hdrlab.capture.camera import Camera, shoot

CURVES = sorted(responses.RESPONSES)


def S_CURVE(X):
    """Return a response that has no closed-form inverse."""
    return X * X * (3 - 2 * X)


def ramp(low=1e-3, high=2.0, shape=(20, 30)):
    """Return radiance that rises by a constant ratio."""
    return np.geomspace(low, high, shape[0] * shape[1], dtype=np.float32).reshape(shape)


# Responses


@pytest.mark.parametrize("name", CURVES)
def test_every_response_runs_from_0_to_1_and_rises(name):
    M = responses.RESPONSES[name].f(np.linspace(0, 1, 4097))
    assert np.isclose(M[0], 0, atol=1e-12) and np.isclose(M[-1], 1)
    assert np.all(np.diff(M) > 0)


@pytest.mark.parametrize("name", CURVES)
def test_every_inverse_undoes_its_response(name):
    f, inverse = responses.RESPONSES[name]
    X = np.linspace(0, 1, 1001)
    # the published constants of sRGB meet to 1e-7 only
    assert np.allclose(inverse(f(X)), X, atol=2e-7)


def test_the_cubic_response_is_the_root_of_its_polynomial():
    X = np.linspace(0, 1, 101)
    M = responses.cubic(X)
    assert np.allclose(M + 3 * M**3, 4 * X)


def test_bisection_inverts_any_rising_function():
    X = np.linspace(0.01, 0.99, 99)
    assert np.allclose(responses.bisect(S_CURVE)(S_CURVE(X)), X, atol=1e-12)


@pytest.mark.parametrize("name", [*CURVES, S_CURVE])
@pytest.mark.parametrize("n", [256, 65536])
def test_the_true_g_is_finite_rising_and_zero_in_the_middle(name, n):
    g = responses.true_g(name, n)
    assert g.shape == (n,) and np.isfinite(g).all()
    assert g[n // 2] == 0 and np.all(np.diff(g) > 0)


def test_the_true_g_of_a_linear_camera_is_the_logarithm_of_the_level():
    assert np.allclose(responses.true_g("linear")[1:], np.log(np.arange(1, 256) / 128))


def test_the_default_response_is_linear():
    assert responses.as_response(None) is responses.as_response("linear")


@pytest.mark.parametrize(
    "bad", ["kodachrome", lambda X: 1 - X, lambda X: 2 * X, lambda X: 0 * X, lambda X: 0.5]
)
def test_invalid_responses_raise_an_error(bad):
    with pytest.raises(ValueError, match="response"):
        responses.as_response(bad)


# One equation each


def test_exposure_is_radiance_times_time_times_sensitivity():
    assert np.array_equal(
        sensor.exposure(np.float32([1, 2]), 0.5, sensitivity=4), np.float32([2, 4])
    )


def test_the_variance_of_the_photons_is_their_mean():
    for X in (0.001, 0.1, 0.5):
        N = sensor.photons(
            np.full(200_000, X, np.float32), full_well=10_000, rng=np.random.default_rng(1)
        )
        assert np.isclose(N.mean(), 10_000 * X, rtol=0.01)
        assert np.isclose(N.var(), 10_000 * X, rtol=0.02)


def test_photons_are_limited_by_the_full_well():
    N = sensor.photons(np.float32([2, 100, np.inf]), full_well=1000, rng=np.random.default_rng(1))
    assert np.array_equal(N, [1000, 1000, 1000])


def test_read_noise_has_its_deviation_in_the_dark_and_in_the_light():
    for N in (0, 5000):
        noisy = sensor.readout(
            np.full(100_000, N, np.float32), read_noise=7, rng=np.random.default_rng(2)
        )
        assert np.isclose(noisy.mean(), N, atol=0.1) and np.isclose(noisy.std(), 7, rtol=0.02)


@pytest.mark.parametrize(("bits", "dtype"), [(8, np.uint8), (16, np.uint16)])
def test_quantising_rounds_to_the_nearest_level_and_clamps(bits, dtype):
    top = 2**bits - 1
    Z = sensor.quantise(np.array([-0.1, 0, 0.49 / top, 0.51 / top, 1, 7]), bits=bits)
    assert Z.dtype == dtype and Z.tolist() == [0, 0, 0, 1, top, top]


# Photographs


@pytest.mark.parametrize("response", [*CURVES, S_CURVE])
@pytest.mark.parametrize("bits", [8, 16])
def test_a_photograph_without_noise_inverts_to_its_exposure_within_half_a_level(response, bits):
    E = ramp(1e-4, 1)
    f, _ = responses.as_response(response)
    Z = shoot(E, [1.0], Camera(response=response, bits=bits)).images[0]
    assert np.all(np.abs(Z - f(E.astype(np.float64)) * (2**bits - 1)) <= 0.51)


def test_g_of_every_level_agrees_with_the_exposures_that_gave_it():
    E = ramp(1e-3, 0.99, (200, 500))
    Z = shoot(E, [1.0]).images[0]
    g = responses.true_g("film")
    means = np.array([np.log(E[Z == z]).mean() for z in range(20, 250)])
    assert np.allclose(means - means[108], g[20:250], atol=0.004)


@settings(deadline=None)  # a busy machine is no failure
@given(k=st.integers(-6, 6), seed=st.integers(0, 99))
def test_more_light_and_more_time_make_the_same_photograph(k, seed):
    E = ramp()
    factor = 2.0**k
    knobs = dict(full_well=5000, read_noise=4)
    brighter = shoot(factor * E, [0.25, 1], Camera(**knobs), rng=5)
    longer = shoot(E, factor * np.array([0.25, 1]), Camera(**knobs), rng=5)
    faster = shoot(E, [0.25, 1], Camera(sensitivity=factor, **knobs), rng=5)
    assert np.array_equal(brighter.images, longer.images)
    assert np.array_equal(longer.images, faster.images)


def test_a_longer_exposure_is_nowhere_darker():
    images = shoot(ramp(), [0.1, 0.2, 0.8, 3.0]).images
    assert np.all(np.diff(images.astype(int), axis=0) >= 0)


def test_clipped_pixels_are_white_and_pixels_without_light_black():
    images = shoot([[0.0, 1.0, 1e30]], [1.0, 1e30]).images
    assert images[:, 0].tolist() == [[0, 255, 255], [0, 255, 255]]


def test_any_order_of_times_gives_the_same_photographs_sorted():
    E = ramp(shape=(40, 50))
    times = np.array([4.0, 0.25, 1.0])
    offsets = np.array([[0, 3], [2, -1], [0, 0]])
    knobs = dict(full_well=9000, read_noise=3, hot=0.01)
    a = shoot(E, times, Camera(**knobs), offsets=offsets, rng=5)
    b = shoot(E, times[[1, 2, 0]], Camera(**knobs), offsets=offsets[[1, 2, 0]], rng=5)
    assert a.times.tolist() == [0.25, 1.0, 4.0] == b.times.tolist()
    assert np.array_equal(a.images, b.images)


@pytest.mark.parametrize("shape", [(12, 17), (12, 17, 3)])
@pytest.mark.parametrize(("bits", "dtype"), [(8, np.uint8), (16, np.uint16)])
def test_frames_have_the_shape_of_the_scene_and_the_requested_bits(shape, bits, dtype):
    taken = shoot(np.ones(shape), [0.1, 0.2], Camera(bits=bits))
    assert taken.images.shape == (2, *shape) and taken.images.dtype == dtype
    assert taken.valid is None and not taken.linear


def test_a_bracket_of_a_linear_camera_is_marked_as_linear():
    assert shoot(ramp(), [1.0], Camera(response="linear")).linear
    assert shoot(ramp(), [1.0], Camera(response=None)).linear


def test_a_seed_determines_the_noise_and_a_generator_advances():
    knobs = dict(full_well=3000, read_noise=5, gray_noise=0.5)
    assert np.array_equal(
        shoot(ramp(), [1.0], Camera(**knobs), rng=3).images,
        shoot(ramp(), [1.0], Camera(**knobs), rng=3).images,
    )
    assert np.any(
        shoot(ramp(), [1.0], Camera(**knobs), rng=3).images
        != shoot(ramp(), [1.0], Camera(**knobs), rng=4).images
    )
    rng = np.random.default_rng(3)
    first = shoot(ramp(), [1.0], Camera(**knobs), rng=rng).images
    second = shoot(ramp(), [1.0], Camera(**knobs), rng=rng).images
    assert np.any(first != second)


def test_frames_of_one_exposure_differ_in_their_noise():
    a, b = shoot(ramp(), [1.0, 1.0], Camera(full_well=3000)).images
    assert np.any(a != b)


def test_gray_noise_has_its_deviation_in_levels():
    Z = shoot(np.full((300, 300), 0.3), [1.0], Camera(gray_noise=3.0)).images
    assert np.isclose(Z.std(), 3.0, rtol=0.02)


def test_the_noisy_experiment_of_cerman_and_hlavac_can_be_set_up():
    E = ramp(1 / 1024, 1, (200, 300))
    taken = shoot(
        E, 4.0 ** np.arange(6), Camera(response="cubic", gray_noise=1.0, sensitivity=1.0), rng=0
    )
    clean = shoot(E, 4.0 ** np.arange(6), Camera(response="cubic"))
    middle = (clean.images > 5) & (clean.images < 250)
    error = taken.images[middle].astype(float) - clean.images[middle]
    assert np.isclose(error.mean(), 0, atol=0.02)
    assert np.isclose(error.std(), np.sqrt(1 + 1 / 6), rtol=0.03)


def test_hot_pixels_are_white_in_every_frame_regardless_of_camera_shake():
    E = np.full((60, 70, 3), 0.01)
    offsets = camera.shake(3, radius=4)
    images = shoot(E, [0.1, 0.2, 0.4], Camera(hot=0.02), offsets=offsets).images
    white = images == 255
    assert np.array_equal(white[0], white[1]) and np.array_equal(white[1], white[2])
    assert np.isclose(white[0].mean(), 0.02, atol=0.006)
    assert images[~white].max() < 30


# The hand


def test_shifting_a_frame_by_its_offset_aligns_it_with_the_reference():
    E = np.random.default_rng(0).random((40, 50)).astype(np.float32)
    offsets = np.array([[3, -2], [0, 0], [-4, 5]])
    # as good as one time, in this order
    images = shoot(E, [0.5, 0.500001, 0.500002], offsets=offsets).images
    assert images.shape == (3, 40 - 7, 50 - 7)
    for image, (dy, dx) in zip(images, offsets, strict=True):
        moved = np.roll(image, (dy, dx), axis=(0, 1))
        assert np.array_equal(moved[5:-5, 5:-5], images[1][5:-5, 5:-5])


def test_views_returns_the_radiance_seen_by_each_frame():
    E = ramp(shape=(40, 50))
    offsets = camera.shake(3, radius=3, rng=8)
    images = shoot(E, [0.1, 0.4, 1.6], offsets=offsets).images
    for image, view, time in zip(images, camera.views(E, offsets), [0.1, 0.4, 1.6], strict=True):
        assert np.array_equal(image, shoot(view, [time]).images[0])


def test_a_tripod_sees_the_whole_scene():
    E = ramp()
    assert np.array_equal(camera.views(E, np.zeros((2, 2), int))[1], E)


def test_shake_stays_within_its_radius_and_keeps_the_middle_frame():
    offsets = camera.shake(500, radius=3, rng=1)
    assert offsets.shape == (500, 2) and np.array_equal(np.unique(offsets), np.arange(-3, 4))
    assert np.array_equal(camera.shake(5)[2], [0, 0])
    assert np.array_equal(camera.shake(5), camera.shake(5))


# Exposure times


def test_times_around_returns_times_the_requested_stops_apart():
    times = camera.times_around(ramp(), 6, stops=1.5)
    assert times.shape == (6,) and np.allclose(np.diff(np.log2(times)), 1.5)


@settings(deadline=None)  # a busy machine is no failure
@given(k=st.integers(-20, 20))
def test_a_brighter_scene_takes_shorter_times(k):
    assert np.allclose(camera.times_around(2.0**k * ramp()), camera.times_around(ramp()) / 2.0**k)


def test_the_middle_time_brings_the_log_average_to_the_middle():
    E = ramp(0.01, 1, (21, 21))
    assert np.isclose(camera.times_around(E, 5, middle=0.2)[2] * np.exp(np.log(E).mean()), 0.2)


def test_black_pixels_do_not_lengthen_the_exposure():
    E = np.array([[0.0, 1.0], [1.0, 0.0]])
    assert np.isclose(camera.times_around(E, 1, middle=0.5)[0], 0.5)


# Bad input


@pytest.mark.parametrize(
    ("knobs", "message"),
    [
        (dict(times=[]), "times"),
        (dict(times=[0.0]), "positive exposure times"),
        (dict(times=[1.0, np.nan]), "positive exposure times"),
        (dict(E=[[-1.0]]), "negative"),
        (dict(E=[[np.nan]]), "NaN"),
        (dict(E=np.ones((4, 4, 2))), "radiance"),
        (dict(bits=12), "8 or 16 bits"),
        (dict(sensitivity=0), "sensitivity"),
        (dict(full_well=-1), "full well"),
        (dict(full_well=np.nan), "full well"),
        (dict(full_well=100, read_noise=-1), "read_noise"),
        (dict(read_noise=2), "finite full_well"),
        (dict(gray_noise=np.inf), "gray_noise"),
        (dict(hot=1.5), "hot"),
        (dict(response="polaroid"), "film"),
        (dict(offsets=[[0, 0], [1, 1]]), "one per time"),
        (dict(offsets=3), "one per time"),
        (dict(offsets=[[np.nan, 0]]), "finite homographies"),
        (dict(times=[1.0, 2.0], offsets=[[0, 0], [0, 30]]), "span less"),
    ],
)
def test_invalid_arguments_raise_an_error_that_names_the_value(knobs, message):
    with pytest.raises(ValueError, match=message):
        taken = {name: knobs.pop(name) for name in ("E", "times", "offsets") if name in knobs}
        shoot(**{"E": ramp(), "times": [1.0], **taken}, camera=Camera(**knobs))


def test_shake_without_frames_and_a_black_scene_raise_an_error():
    with pytest.raises(ValueError, match="at least one frame"):
        camera.shake(0)
    with pytest.raises(ValueError, match="at least one frame"):
        camera.times_around(ramp(), 0)
    with pytest.raises(ValueError, match="positive"):
        camera.times_around(ramp(), stops=0)
    with pytest.raises(ValueError, match="zeros"):
        camera.times_around(np.zeros((3, 3)))


def test_shake_reaches_its_radius_and_not_more():
    assert np.abs(camera.shake(2000)).max() == 8
    assert np.abs(camera.shake(2000, radius=3)).max() == 3
