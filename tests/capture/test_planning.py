"""A planned bracket covers the scene with as few photos as possible."""

from itertools import combinations_with_replacement

import numpy as np
import pytest
from hypothesis import given, strategies as st

from hdrlab.capture import exposure, planning
from hdrlab.errors import InputError
from hdrlab.radiance.uncertainty import inverse_variance_merge


@given(
    low=st.floats(1e-4, 1e3),
    scene=st.floats(0, 20),
    usable=st.floats(4, 12),
    overlap=st.floats(0, 3),
    per_stop=st.sampled_from([1, 3]),
)
def test_the_plan_covers_every_luminance_and_neighbors_overlap(
    low, scene, usable, overlap, per_stop
):
    high = low * 2**scene
    plan = planning.plan(low, high, usable=usable, overlap=overlap, per_stop=per_stop)
    assert plan.holds[:, 0].min() <= low * (1 + 1e-6)
    assert plan.holds[:, 1].max() >= high * (1 - 1e-6)
    shared = np.log2(plan.holds[1:, 1] / plan.holds[:-1, 0])
    assert np.all(shared >= overlap - 1e-6)


@given(scene=st.floats(0, 20), usable=st.floats(4, 12))
def test_one_photograph_fewer_would_not_reach_the_darkest(scene, usable):
    plan = planning.plan(1.0, 2.0**scene, usable=usable, overlap=1, per_stop=3)
    assert len(plan.times) == 1 or plan.holds[-2, 0] > 1


def test_the_formula_counts_photographs():
    assert [planning.count(s, 7, 3) for s in (0, 7, 7.1, 11, 15.1)] == [1, 1, 2, 2, 4]


def test_times_are_powers_of_two_and_named_as_on_the_dial():
    plan = planning.plan(0.01, 1000)
    assert np.log2(plan.times) == pytest.approx(np.round(np.log2(plan.times)))
    assert plan.names == ("1/15", "1", "15", "256")


def test_the_shortest_exposure_just_holds_the_brightest_luminance():
    plan = planning.plan(0.01, 1000, per_stop=3)
    assert 1000 <= plan.holds[0, 1] < 1000 * 2 ** (1 / 3)
    assert plan.holds[0, 1] == pytest.approx(exposure.saturating_luminance(plan.times[0]))


def test_four_times_the_speed_takes_a_quarter_of_the_time():
    slow = planning.plan(0.01, 1000)
    fast = planning.plan(0.01, 1000, iso=400)
    assert fast.times == pytest.approx(slow.times / 4)


@pytest.mark.parametrize(("low", "high"), [(0, 1), (2, 1), (-1, 1), (1, np.inf), (np.nan, 1)])
def test_invalid_luminances_raise_an_error(low, high):
    with pytest.raises(ValueError, match="luminances"):
        planning.plan(low, high)


def test_an_overlap_that_leaves_no_step_raises_an_error():
    with pytest.raises(ValueError, match="overlap"):
        planning.plan(1, 10, usable=4, overlap=4)
    with pytest.raises(ValueError, match="step"):
        planning.plan(1, 10, usable=4, overlap=3.9)


MAKERS = [
    planning.Model(),
    planning.Model(read_noise=1, converter_noise=4, speeds=(100, 400, 1600), pause=0.05),
    planning.Model(full_well=3000, gain=1, pause=1, aperture=4),
]


@pytest.mark.parametrize("maker", MAKERS)
@pytest.mark.parametrize(("low", "high", "snr"), [(0.5, 500, 20), (2, 50, 60), (1, 1, 5)])
def test_planning_by_noise_reaches_the_requested_snr_at_each_luminance(maker, low, high, snr):
    names, times, speeds = planning.plan_by_noise(low, high, snr, maker)
    every = planning.squared_snr(np.geomspace(low, high, 2001), times, speeds, maker).sum(axis=1)
    assert every.min() >= snr**2 * (1 - 1e-6)
    worst = planning.worst_snr(low, high, times, speeds, maker)
    assert snr * (1 - 1e-6) <= worst <= np.sqrt(every.min()) * (1 + 1e-6)
    assert len(names) == len(times)
    assert np.all(np.diff(times) >= 0)
    assert set(speeds) <= set(maker.speeds)


@pytest.mark.parametrize("maker", MAKERS[1:])
def test_planning_by_noise_finds_the_quickest_three_photos(maker):
    low = 5.0
    high = 200.0
    snr = 12.0
    plan = planning.plan_by_noise(low, high, snr, maker)
    took = plan.times.sum() + maker.pause * len(plan.times)
    settings = [(t, S) for t in 2.0 ** np.arange(-12, 5) for S in maker.speeds]
    quickest = np.inf
    for count in (1, 2, 3):
        for chosen in combinations_with_replacement(settings, count):
            times, speeds = np.array(chosen).T
            needs = times.sum() + maker.pause * count
            if needs < quickest and planning.worst_snr(low, high, times, speeds, maker) >= snr:
                quickest = needs
    assert took <= 1.01 * quickest


def test_the_ratio_of_a_plan_is_that_of_the_mean_by_inverse_variance():
    L = 2.0
    maker = planning.Model()
    _, times, speeds = planning.plan_by_noise(1, 50, 15, maker)
    full = exposure.saturating_luminance(times, S=speeds)
    X = np.broadcast_to((L / full)[:, None], (len(times), 20_000))
    rng = np.random.default_rng(3)
    counted = rng.poisson(X * maker.full_well) + maker.read_noise * rng.standard_normal(X.shape)
    step = np.full(X.shape, maker.gain / maker.full_well)
    light = step * np.round(counted / maker.full_well / step)
    E, _ = inverse_variance_merge(light, step, X < 1, times, maker.full_well, maker.read_noise)
    ratio = np.sqrt(planning.squared_snr([L], times, speeds, maker).sum())
    assert E.mean() / E.std() == pytest.approx(ratio, rel=0.03)


@pytest.mark.parametrize(
    ("maker", "snr"),
    [
        *(
            (planning.Model(**bad), 20)
            for bad in ({"full_well": 0}, {"pause": -1}, {"read_noise": np.nan})
        ),
        *((planning.Model(), snr) for snr in (0, np.nan, 1e9)),
    ],
)
def test_planning_by_noise_raises_an_error_for_invalid_arguments(maker, snr):
    with pytest.raises(InputError):
        planning.plan_by_noise(0.1, 1000, snr, maker)


def test_a_plan_does_not_depend_on_earlier_plans():
    first = planning.plan_by_noise(1, 50, 15)
    planning.plan_by_noise(0.1, 3000, 20)
    assert planning.plan_by_noise(1, 50, 15).names == first.names


def test_a_bracket_around_a_time_uses_the_nearest_times_of_the_camera():
    dial = exposure.read_dial(["bulb", "1/30", "1/125", "1/60", "1/15", "0.25s", "1/4000"])
    chosen = planning.around(1 / 60, dial.values, 3, 2.0)
    assert [dial.names[j] for j in chosen] == ["1/125", "1/60", "1/15"]


def test_a_bracket_is_shifted_to_stay_within_the_cameras_times():
    times = 2.0 ** np.arange(-10, 1)
    assert np.log2(times[planning.around(0.5, times, 4, 2.0)]).tolist() == [-6, -4, -2, 0]
    assert np.log2(times[planning.around(0.001, times, 4, 2.0)]).tolist() == [-10, -8, -6, -4]


@pytest.mark.parametrize(("frames", "stops"), [(6, 2.5), (12, 1), (5, 0.4)])
def test_a_bracket_with_two_equal_times_raises_an_error(frames, stops):
    with pytest.raises(
        ValueError, match=f"{frames} times {stops:g} stops apart, .*camera has only 11 over"
    ):
        planning.around(0.1, 2.0 ** np.arange(-10, 1), frames, stops)
