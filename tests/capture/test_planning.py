"""A planned bracket covers the scene, with no more photographs than it takes."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hdrlab.capture import exposure, planning


@given(
    low=st.floats(1e-4, 1e3),
    scene=st.floats(0, 20),
    usable=st.floats(4, 12),
    overlap=st.floats(0, 3),
    per_stop=st.sampled_from([1, 3]),
)
def test_every_luminance_of_the_scene_is_held_and_neighbours_overlap(low, scene, usable, overlap, per_stop):
    high = low * 2**scene
    plan = planning.plan(low, high, usable=usable, overlap=overlap, per_stop=per_stop)
    assert plan.holds[:, 0].min() <= low * (1 + 1e-6) and plan.holds[:, 1].max() >= high * (1 - 1e-6)
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


def test_the_shortest_just_holds_the_brightest():
    plan = planning.plan(0.01, 1000, per_stop=3)
    assert 1000 <= plan.holds[0, 1] < 1000 * 2 ** (1 / 3)
    assert plan.holds[0, 1] == pytest.approx(exposure.saturating_luminance(plan.times[0]))


def test_four_times_the_speed_takes_a_quarter_of_the_time():
    slow, fast = planning.plan(0.01, 1000), planning.plan(0.01, 1000, iso=400)
    assert fast.times == pytest.approx(slow.times / 4)


@pytest.mark.parametrize(("low", "high"), [(0, 1), (2, 1), (-1, 1), (1, np.inf), (np.nan, 1)])
def test_luminances_that_mean_nothing_are_refused(low, high):
    with pytest.raises(ValueError, match="expected luminances"):
        planning.plan(low, high)


def test_an_overlap_that_leaves_no_step_is_refused():
    with pytest.raises(ValueError, match="overlap"):
        planning.plan(1, 10, usable=4, overlap=4)
    with pytest.raises(ValueError, match="step"):
        planning.plan(1, 10, usable=4, overlap=3.9)
