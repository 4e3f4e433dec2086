"""The sensor and its converter: the range of one exposure; gain and read noise estimated from photos."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from hdrlab import scenes
from hdrlab.capture import camera, photon_transfer, ranges, sensor
from hdrlab.capture.sensor import Sensor
from hdrlab.errors import InputError

QUIET = Sensor(read_noise=0, full_well=1e9, gain=1e9 / 4000, bits=12, black=64)


def flats(device, count=14, *, side=200, seed=0, uneven=None):
    """Return pairs (M, 2, side, side) of RAW levels: dark ones, and of a white wall until it is
    clipped.
    """
    wall = np.ones((side, side)) if uneven is None else uneven
    rng = np.random.default_rng(seed)
    times = np.r_[0, np.linspace(0.05, 1.3, count)]
    return np.stack([[sensor.raw(wall, t, device, rng=rng) for _ in range(2)] for t in times])


# Dynamic range


def test_1000_to_a_hundredth_are_five_decades_16_6_stops_and_100_decibels():
    decades, stops, decibels = ranges.dynamic_range(1000, 0.01)
    assert decades == pytest.approx(5, abs=1e-12) and decibels == pytest.approx(100, abs=1e-10)
    assert stops == pytest.approx(np.log2(1e5))


@given(low=st.floats(1e-6, 1e3), k=st.integers(0, 30))
def test_each_doubling_of_the_brightest_adds_a_stop(low, k):
    assert ranges.dynamic_range(low * 2.0**k, low).stops == pytest.approx(k, abs=1e-9)


def test_the_range_of_a_sensor_is_its_well_over_its_noise():
    device = Sensor(full_well=20_000, read_noise=2, gain=1e-9 + 20_000 / 65_000, bits=16, black=0)
    assert ranges.sensor_range(device).decades == pytest.approx(4, abs=1e-3)


def test_the_range_is_largest_at_an_intermediate_gain():
    high = ranges.sensor_range(Sensor(gain=40)).stops
    base = ranges.sensor_range(Sensor(gain=5)).stops
    low = ranges.sensor_range(Sensor(gain=1)).stops
    assert high < base and low < base
    assert (
        sensor.full_electrons(Sensor(gain=1))
        == 4095 - 64
        < 20_000
        == sensor.full_electrons(Sensor(gain=5))
    )


# Levels


def test_half_of_the_levels_are_in_the_brightest_stop_and_12_bits_have_16_times_as_many_as_8():
    eight = ranges.levels_per_stop(8)
    twelve = ranges.levels_per_stop(12)
    assert eight[0] == 128 and eight.sum() == 255 and twelve.sum() == 4095
    assert np.array_equal(twelve[:8], 16 * eight)


def test_each_bit_halves_the_rounding_error():
    X = np.random.default_rng(0).random((400, 500)).astype(np.float32)
    rms = {}
    for bits in (8, 12):
        device = QUIET._replace(bits=bits, black=0, gain=1e9 / (2**bits - 1))
        rms[bits] = np.std(sensor.develop(sensor.digitise(X * 1e9, device), device) - X)
        assert rms[bits] == pytest.approx(1 / (2**bits - 1) / np.sqrt(12), rel=0.01)
    assert rms[8] / rms[12] == pytest.approx(4095 / 255, rel=0.01)


def test_a_ramp_has_256_levels_with_8_bits_and_4096_with_12():
    for bits in (8, 12):
        device = QUIET._replace(bits=bits, black=0, gain=1e9 / (2**bits - 1))
        assert (
            len(np.unique(sensor.digitise(np.linspace(0, 1e9, 50_000, dtype=np.float32), device)))
            == 2**bits
        )


def test_without_a_black_level_the_dark_is_too_bright():
    dark = np.zeros((300, 300), np.float32)
    means = {}
    for black in (0, 64):
        device = Sensor(read_noise=10, gain=2, black=black)
        Z = sensor.raw(dark, 1.0, device)
        means[black] = (Z.astype(float) - black).mean() * device.gain
    assert abs(means[64]) < 0.2
    # the mean of half a Gaussian, cut at 0
    assert means[0] == pytest.approx(10 / np.sqrt(2 * np.pi), rel=0.1)


@given(K=st.floats(0.5, 50), N=st.integers(0, 15_000))
def test_electrons_can_be_computed_from_levels_within_half_a_level(K, N):
    device = Sensor(gain=K, bits=16, black=100)
    Z = sensor.digitise(np.array([[N]], np.float32), device)
    assert abs(K * (float(Z[0, 0]) - 100) - N) <= K / 2 + 1e-2


# One exposure of a wide scene


def test_a_longer_exposure_covers_the_same_range_of_darker_luminances():
    L = np.geomspace(1e-4, 1e4, 8001)
    ends = []
    for time in (0.01, 0.16):
        exposed = ranges.expose_levels(L, time, Sensor())
        kept = L[~exposed.full & ~exposed.noise]
        ends.append((kept[0], kept[-1]))
    (low_1, high_1), (low_2, high_2) = ends
    assert high_1 / high_2 == pytest.approx(16, rel=0.01)
    assert low_1 / low_2 == pytest.approx(16, rel=0.01)


def test_high_exposure_loses_the_highlights_and_low_exposure_the_shadows():
    L = np.geomspace(0.01, 10, 301)
    coarse = Sensor(bits=3, gain=20_000 / 7, black=0)  # eight levels, as in the overview's figures
    long = ranges.expose_levels(L, 1.0, coarse)
    short = ranges.expose_levels(L, 0.1, coarse)
    assert long.full.mean() > 0.3 and not short.full[:-1].any()
    assert short.noise.mean() > 2 * long.noise.mean()
    fine = np.flatnonzero(np.diff(long.Z))[:3]
    wide = np.flatnonzero(np.diff(short.Z))[:3]
    assert np.all(L[fine] < L[wide] / 9)  # the same levels lie ten times as close to the dark


def test_the_signal_over_noise_is_that_of_many_photographs():
    device = Sensor()
    for X in (0.001, 0.05, 0.6):
        Z = sensor.raw(np.full((300, 300), X), 1.0, device).astype(float) - device.black
        assert Z.mean() / Z.std() == pytest.approx(float(ranges.snr(X, device)), rel=0.02)


# The picture


def test_vignetting_darkens_the_corners_by_its_fraction_and_not_the_center():
    bright = sensor.falloff((101, 151), 0.4)
    assert bright[50, 75] == 1 and np.allclose(bright[[0, 0, -1, -1], [0, -1, 0, -1]], 0.6)
    b = camera.shoot(
        np.full((101, 151), 0.5), [1.0], camera.Camera(response="linear", vignetting=0.4, bits=16)
    )
    assert np.allclose(b.images[0] / 65535, 0.5 * bright, atol=1e-4)


def test_white_balance_makes_a_gray_card_gray_and_keeps_full_pixels_white():
    lamp = np.array([0.9, 0.6, 0.25])
    E = np.stack([np.full((4, 3), 0.2 * part) for part in lamp], axis=-1)
    E[2:] = 50
    X = sensor.develop(sensor.raw(E, 1.0, QUIET), QUIET, white=sensor.balance(lamp))
    assert np.allclose(X[:2], X[:2, :, :1], atol=2e-3) and np.all(X[2:] == 1)


def test_a_bayer_camera_shows_an_even_wall_as_one_that_reads_all_colours_does():
    E = np.ones((20, 30, 3)) * [0.2, 0.4, 0.1]
    whole = camera.shoot(E, [1.0], camera.Camera(sensor=QUIET, bayer=False))
    mosaicked = camera.shoot(E, [1.0], camera.Camera(sensor=QUIET, bayer=True))
    assert np.abs(whole.images.astype(int) - mosaicked.images).max() <= 1


def test_a_camera_with_a_fine_converter_photographs_as_one_without():
    E = scenes.room((48, 72))
    times = camera.times_around(E, 3)
    fine = Sensor(full_well=50_000, read_noise=0, gain=1.0, bits=16, black=100)
    with_one = camera.shoot(E, times, camera.Camera(sensor=fine), rng=1).images.astype(float)
    without = camera.shoot(E, times, camera.Camera(full_well=50_000), rng=1).images
    assert np.abs(with_one - without).mean() < 0.3


def test_hot_pixels_burn_through_a_mosaic_too():
    taken = camera.shoot(
        np.full((60, 60, 3), 0.01), [1.0], camera.Camera(sensor=Sensor(), bayer=True, hot=0.01)
    )
    burnt = (taken.images > 250).mean()  # a third of the channels of a hot pixel are its own
    assert burnt == pytest.approx(0.01 / 3, rel=0.5)


# Photon transfer


@pytest.mark.parametrize(
    "device",
    [
        Sensor(),
        Sensor(full_well=5_000, read_noise=2, gain=1.2, bits=14, black=512),
        Sensor(full_well=60_000, read_noise=12, gain=15),
    ],
)
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_flat_frames_give_gain_and_read_noise_to_three_percent(device, seed):
    calibrated = photon_transfer.calibrate(flats(device, seed=seed))
    assert calibrated.gain == pytest.approx(device.gain, rel=0.03)
    assert calibrated.read_noise == pytest.approx(device.read_noise, rel=0.03)
    assert calibrated.black == pytest.approx(device.black, abs=0.1)
    assert calibrated.full_well == pytest.approx(sensor.full_electrons(device), rel=0.03)


def test_dust_and_vignetting_do_not_disturb_the_calibration():
    dusty = sensor.falloff((200, 200), 0.3) * np.random.default_rng(8).normal(1, 0.03, (200, 200))
    calibrated = photon_transfer.calibrate(flats(Sensor(), uneven=dusty))
    assert calibrated.gain == pytest.approx(5, rel=0.03)
    assert calibrated.read_noise == pytest.approx(5, rel=0.03)
    single = flats(Sensor(), uneven=dusty)[8, 0].astype(float).var()
    assert single > 5 * calibrated.V[8]  # one photograph's own variance is mostly dust


def test_the_variance_grows_with_the_signal_and_falls_when_the_well_is_full():
    calibrated = photon_transfer.calibrate(flats(Sensor()))
    assert np.all(np.diff(calibrated.V[calibrated.used]) > 0)
    assert calibrated.V[-1] < calibrated.V[calibrated.used][-1] / 10
    assert not calibrated.used[-1]


def test_photon_transfer_raises_an_error_for_jpegs_whose_noise_does_not_grow():
    pairs = flats(Sensor())
    curved = np.round(255 * np.clip((pairs - 64.0) / 4000, 0, 1) ** (1 / 2.2)).astype(np.uint8)
    with pytest.raises(ValueError, match="noise that grows"):
        photon_transfer.calibrate(curved)


def counted_wall(gain, read_noise, black, *, seed=0):
    """Return pairs (M, 2, 200, 200) of RAW levels of a uniform wall, clipped at 0."""
    rng = np.random.default_rng(seed)
    electrons = np.linspace(0, 20_000, 10)[:, None, None, None] * np.ones((10, 2, 200, 200))
    noisy = rng.poisson(electrons) + rng.normal(0, read_noise, electrons.shape)
    return np.round(noisy / gain + black).clip(0).astype(np.uint16)


@pytest.mark.parametrize("black", [100.0, 100.3, 100.5])
def test_read_noise_below_half_a_level_is_an_interval_and_no_number(black):
    """12 bits at base ISO: the dark pair's variance depends on where black lies in a level."""
    calibrated = photon_transfer.calibrate(counted_wall(10, 2, black))
    low, high = calibrated.read_noise_interval
    assert np.isnan(calibrated.read_noise)
    assert low <= 2 <= high <= 5.1
    assert calibrated.gain == pytest.approx(10, rel=0.02)


@pytest.mark.parametrize("read_noise", [6, 20])
def test_black_at_level_0_changes_neither_read_noise_nor_gain(read_noise):
    calibrated = photon_transfer.calibrate(counted_wall(2, read_noise, 0))
    assert calibrated.read_noise == pytest.approx(read_noise, rel=0.03)
    assert calibrated.gain == pytest.approx(2, rel=0.01)
    assert calibrated.black == pytest.approx(0, abs=0.1)


@pytest.mark.papers
def test_the_interval_of_the_read_noise_contains_it_in_about_95_of_100_walls():
    inside = 0
    for seed in range(60):
        pairs = counted_wall(2, 6, 100, seed=seed)[:, :, :40, :40]
        low, high = photon_transfer.calibrate(pairs).read_noise_interval
        inside += low <= 6 <= high
    assert 52 <= inside <= 60


@pytest.mark.parametrize(
    "Z",
    [
        np.zeros((5, 2, 20, 20)),
        np.zeros((5, 3, 20, 20), np.uint16),
        np.zeros((2, 2, 20, 20), np.uint16),
        np.zeros((5, 2, 20, 20), np.uint16),
        np.zeros((5, 2, 3, 3), np.uint16),
    ],
)
def test_photon_transfer_raises_an_error_for_unusable_photos(Z):
    with pytest.raises(InputError):
        photon_transfer.calibrate(Z)


# Bad input


@pytest.mark.parametrize(
    ("knobs", "message"),
    [
        (dict(vignetting=1.5), "vignetting"),
        (dict(bayer=True), "expected a sensor"),
        (dict(white=(2, 1, 1)), "expected a sensor"),
        (dict(sensor=Sensor(), full_well=1000), "not both"),
        (dict(sensor=Sensor(), read_noise=3), "finite full_well"),
        (dict(sensor=Sensor(bits=20)), "1 to 16 bits"),
        (dict(sensor=Sensor(black=5000)), "black level"),
        (dict(sensor=Sensor(bits=8, black=255)), "black level"),
        (dict(sensor=Sensor(), white=(0, 1, 1)), "positive gains"),
        (dict(sensor=Sensor(), E=np.ones((4, 4)), bayer=True), "radiance"),
    ],
)
def test_an_invalid_sensor_raises_an_error_that_names_the_value(knobs, message):
    E = knobs.pop("E", np.ones((4, 4, 3)))
    with pytest.raises(ValueError, match=message):
        camera.shoot(E, [1.0], camera.Camera(**knobs))


def test_invalid_numbers_raise_an_error():
    for call in (
        lambda: ranges.dynamic_range(0.1, 1),
        lambda: ranges.dynamic_range(1, 0),
        lambda: ranges.levels_per_stop(0),
        lambda: ranges.expose_levels([-1.0], 1.0, Sensor()),
        lambda: ranges.expose_levels([1.0], 0.0, Sensor()),
        lambda: sensor.raw(np.ones((4, 4)), -1.0),
        lambda: sensor.balance([1, 0, 1]),
        lambda: sensor.develop(np.ones((4, 4))),
        lambda: sensor.develop(np.ones((4, 4, 3), np.uint16), bayer=True),
    ):
        with pytest.raises(InputError):
            call()


def test_digitise_clips_to_the_levels_of_the_converter():
    small = Sensor(full_well=50_000, gain=1, bits=12, black=64)
    assert sensor.digitise(np.float32([-1000, 0, 3000, 5000, 50_000]), small).tolist() == [
        0,
        64,
        3064,
        4095,
        4095,
    ]


def test_an_exposure_that_just_fills_the_sensor_counts_as_full():
    full = Sensor(full_well=1000, gain=1, bits=12, black=0, read_noise=1)
    exposed = ranges.expose_levels([0.5, 1.0, 2.0], 1.0, full)
    assert exposed.full.tolist() == [False, True, True]


@pytest.mark.parametrize("sensitivity", [0, -1, np.inf, np.nan])
def test_a_sensitivity_is_a_positive_number(sensitivity):
    with pytest.raises(ValueError, match="positive sensitivity"):
        sensor.raw(np.ones((2, 2)), 1.0, sensitivity=sensitivity)


def test_photon_transfer_needs_a_pair_beyond_those_that_it_draws_its_line_through():
    rng = np.random.default_rng(0)
    N = np.array([0, 1000, 3000, 6000])[:, None, None, None] * np.ones((4, 2, 64, 64))
    Z = np.round(rng.poisson(N) / 2 + rng.normal(100, 3, N.shape)).astype(np.uint16)
    assert photon_transfer.calibrate(Z).gain == pytest.approx(2, rel=0.1)
    with pytest.raises(ValueError, match="dark pair and three more"):
        photon_transfer.calibrate(Z[:3])
