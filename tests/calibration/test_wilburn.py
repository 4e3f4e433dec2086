"""Calibration from mixtures of two lights: schedules, ramps, joining, and the experiments of the paper.

The benchmarks run the published experiments in full; here are fewer cameras and trials, and the
same limits.
"""

import numpy as np
import pytest

from hdrlab.calibration import display, joining, motion_blur, wilburn
from hdrlab.calibration.blends import (
    Blend,
    InverseResponse,
    difference,
    ln_exposure,
    make_blend,
    rmse,
    select_blends,
)
from hdrlab.calibration.display import Schedule
from hdrlab.capture.responses import RESPONSES, as_response, true_g
from hdrlab.errors import InputError

pytestmark = pytest.mark.papers

ALPHA = np.arange(1, 16) / 15
SOLVERS = {"simplex": wilburn.join, "spline": joining.join}


@pytest.fixture(scope="module")
def papers():
    return pytest.importorskip("benchmarks.papers.mixtures")


@pytest.fixture(scope="module")
def cameras(measured_curves, papers):
    """All measured curves, as functions."""
    return [papers.measured(x, m) for x, m in zip(*measured_curves, strict=True)]


def two_blends(f, dim=0.2, start=0.0):
    """Return two blends without noise: from `start` to 1 and to `dim`."""
    return [Blend(ALPHA, f(start + (end - start) * ALPHA)) for end in (1.0, dim)]


# Schedules


def test_every_patch_is_on_for_its_fraction_of_the_schedule_and_switches_once():
    shown = display.draw_schedule(Schedule((200,), low=7, patch=1, border=0), shape=(3, 5)).reshape(
        15, 15
    )
    assert np.array_equal((shown == 200).mean(axis=0), np.arange(1, 16) / 15)
    assert np.all(np.sum(np.diff(shown.astype(int), axis=0) != 0, axis=0) <= 1)
    assert set(np.unique(shown)) == {
        7,
        200,
    }


def test_the_patches_are_centered_on_black():
    shown = display.draw_schedule(shape=(400, 500))
    assert shown.shape == (15, 400, 500) and not shown[:, 0].any()
    lit = np.argwhere(shown[0])
    assert np.all(lit.min(axis=0) + lit.max(axis=0) == [399, 499])
    assert np.count_nonzero(shown[0]) == 30 * 30 * 30 and set(np.unique(shown[0])) == {0, 100, 220}


def test_the_grid_is_read_back_from_a_photograph_of_it():
    schedule = Schedule((250, 100))
    shown = display.draw_schedule(schedule, shape=(380, 320))
    image = np.round(shown.mean(axis=0)).astype(np.uint8)
    corners = display.find_corners(shown[0])
    read = display.read_blends(image, corners, schedule, low=0, high=1)
    for patch_values, high in zip(read[0], (250, 100), strict=True):
        assert np.allclose(patch_values.M * 255, np.round(high * ALPHA), atol=1e-9)
        assert np.allclose(patch_values.I, ALPHA)


@pytest.mark.quick
@pytest.mark.parametrize(
    "rows", [[[0, 0], [0, 0]], [[0, 9], [0, 0]], [[0, 9], [0, 9]], [[[0, 9], [9, 0]]], [0, 9, 9]]
)
def test_a_photo_without_the_grid_raises_an_error(rows):
    with pytest.raises(ValueError, match="grid, bright on black"):
        display.find_corners(rows)


@pytest.mark.quick
@pytest.mark.parametrize(("scale", "offset"), [(1.0, 0.0), (3.0, 0.7), (0.2, -5.0)])
def test_curves_that_differ_in_scale_and_offset_alone_are_the_same(scale, offset):
    M = np.linspace(0.1, 0.9, 200)
    truth = InverseResponse(M, M**2, np.ones(0), np.ones(0))
    cut = slice(20, -30)
    recovered = InverseResponse(M[cut], scale * M[cut] ** 2 + offset, np.ones(0), np.ones(0))
    for fit in (False, True):
        assert np.allclose(difference(recovered, truth, fit=fit), 0, atol=1e-9)


# Joining


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("name", ["linear", "srgb", "cubic"])
def test_blends_without_noise_give_the_response(solver, name):
    ramps = SOLVERS[solver](two_blends(as_response(name).f))
    true = InverseResponse(ramps.M, as_response(name).inverse(ramps.M), np.ones(0), np.ones(0))
    assert rmse(ramps, true) < 0.002


@pytest.mark.parametrize("solver", SOLVERS)
def test_scales_and_offsets_are_those_of_the_blends(solver):
    recovered = SOLVERS[solver](two_blends(as_response("srgb").f, dim=0.3, start=0.02))
    assert recovered.s[1] / recovered.s[0] == pytest.approx(0.28 / 0.98, rel=0.02)
    assert recovered.r[1] == pytest.approx(recovered.r[0], abs=0.003)


@pytest.mark.parametrize("solver", SOLVERS)
def test_the_unit_of_irradiance_does_not_matter(solver):
    blends = two_blends(as_response("srgb").f)
    other = [Blend(7 * blend.I + 3, blend.M) for blend in blends]
    assert rmse(SOLVERS[solver](other), SOLVERS[solver](blends)) < 2e-4


def test_the_simplex_finds_the_minimum_of_the_quadratic():
    f = as_response("cubic").inverse  # a camera f = inverse: g is no polynomial
    blends = two_blends(f, dim=0.6)
    low = min(blend.M.min() for blend in blends)
    high = max(blend.M.max() for blend in blends)
    Q = wilburn.quadratic_form(
        [Blend(blend.I, (blend.M - low) / (high - low)) for blend in blends], 3
    )
    fixed = np.array([0.0, 1, 0, 0])
    D = np.vstack([np.zeros(2), -np.ones(2), np.eye(2)])
    free = np.linalg.solve(D.T @ Q @ D, -D.T @ Q @ fixed)
    state = list(wilburn.join_steps(blends, degree=3))[-1]
    assert np.allclose(state.a[2:], free, atol=1e-3)
    assert state.E <= 1.001 * wilburn.error(fixed + D @ free, Q)


def test_both_joining_methods_agree_for_a_polynomial_response():
    blends = two_blends(as_response("cubic").f)
    assert rmse(wilburn.join(blends), joining.join(blends)) < 5e-4


def test_the_error_is_the_papers_sum():
    blends = two_blends(as_response("srgb").f)
    a = np.array([0, 0.5, 0.3, 0.2])
    by_hand = 0.0
    for blend in blends:
        s, r = np.polyfit(blend.I, wilburn.evaluate(blend.M, a), 1)
        by_hand += sum(
            (s * x + r - wilburn.evaluate(m, a)) ** 2 for x, m in zip(blend.I, blend.M, strict=True)
        )
    assert wilburn.error(a, wilburn.quadratic_form(blends, 3)) == pytest.approx(by_hand)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_joined_curve_never_falls(solver):
    rng = np.random.default_rng(0)
    blends = [
        Blend(blend.I, blend.M + 0.01 * rng.standard_normal(15))
        for blend in two_blends(as_response("film").f)
    ]
    assert np.all(np.diff(SOLVERS[solver](blends).X) >= -1e-9)


def test_the_table_is_the_chapters_g():
    joined = joining.join([Blend(blend.I, blend.M) for blend in two_blends(as_response("srgb").f)])
    g = ln_exposure(joined, black=joined.r.min())
    true = true_g("srgb")
    assert g.shape == (256,) and g[128] == 0 and np.all(np.diff(g) >= 0)
    assert np.abs(g[32:] - true[32:]).max() < 0.01  # no sample lies lower


def test_several_blends_calibrate_the_screen_too(papers):
    for name in RESPONSES:
        P, light, true = papers.screens_own(name)
        assert P[0] == 0 and np.abs(light - true).max() < 0.002


# Motion


def test_ramps_are_found_at_their_true_positions(papers):
    image = papers.blurred(as_response("linear").f, np.random.default_rng(0), lines=20)
    ramps = motion_blur.find_ramps(image)
    assert [ramp.rises for ramp in ramps] == [False, True] * 20
    for ramp in ramps:
        inside = (40, 140) if not ramp.rises else (180, 280)
        assert inside[0] <= ramp.start < ramp.stop <= inside[1] and ramp.stop - ramp.start > 70


def test_noise_does_not_choose_the_ends_of_a_ramp(papers):
    """Another draw of a line's noise leaves its ramps where they are, so noise has not chosen their ends.

    A line by itself ends where it seems bright enough: just inside of that, what noise has darkened
    is left.
    """
    first = papers.blurred(as_response("film").f, np.random.default_rng(0))
    second = papers.blurred(as_response("film").f, np.random.default_rng(1))
    other = first.copy()
    other[150] = second[150]
    assert motion_blur.find_ramps(first)[300:302] == motion_blur.find_ramps(other)[300:302]

    def first_sample(ramps):
        away = first - first.mean(axis=0)
        return np.mean([away[ramp.row, ramp.start] for ramp in ramps if not ramp.rises])

    alone = [
        ramp._replace(row=k)
        for k, line in enumerate(first)
        for ramp in motion_blur.find_ramps(line[None])
    ]
    tolerance = 3 * 255 * papers.SIGMA / np.sqrt(300)
    assert abs(first_sample(motion_blur.find_ramps(first))) < tolerance < -first_sample(alone)


def test_a_slanted_edge_is_followed_and_other_pixels_are_ignored(papers):
    image = papers.blurred(as_response("srgb").f, np.random.default_rng(2), lines=40)
    wide = np.pad(image, ((0, 0), (120, 120)), mode="edge")
    slanting = np.stack([np.roll(row, 3 * (k - 20)) for k, row in enumerate(wide)])
    straight = motion_blur.find_ramps(wide)
    ramps = motion_blur.find_ramps(slanting)
    assert len(ramps) == len(straight) == 80
    for ramp, straight_ramp in zip(ramps, straight, strict=True):
        assert abs(ramp.start - 3 * (ramp.row - 20) - straight_ramp.start) <= 1  # pixel
    slanting[7] = wide[7, 0]
    slanting[7, 150:190] = np.r_[np.arange(240, 40, -10), np.zeros(20)]  # another, steeper edge
    assert {ramp.row for ramp in ramps} - {
        ramp.row for ramp in motion_blur.find_ramps(slanting)
    } == {7}


def test_a_line_without_an_edge_has_no_ramp():
    flat = np.full((3, 50), 128, np.uint8)
    # dark, but not dark enough
    dip = np.r_[np.full(20, 255), np.full(9, 100), np.full(20, 255)].astype(np.uint8)
    assert motion_blur.find_ramps(flat) == [] and motion_blur.find_ramps(dip[None]) == []


@pytest.mark.parametrize("name", sorted(RESPONSES))
def test_linear_motion_is_accepted_and_15_percent_acceleration_is_rejected(papers, name):
    linear, accelerated = papers.figure7(name, trials=3)
    assert np.all(linear < motion_blur.MAX_RMSE / 3) and np.all(accelerated > motion_blur.MAX_RMSE)


# The paper's table


@pytest.mark.parametrize("name", sorted(RESPONSES))
def test_the_polynomial_reaches_the_published_errors(papers, name):
    got = papers.table1(name, sets=1, lines=60)
    assert got["display, polynomial"].rmse.mean() <= 0.012
    assert got["blur, polynomial"].rmse.mean() <= 0.012
    assert got["display, spline"].disparity.mean() < 0.017
    assert got["blur, spline"].disparity.mean() < 0.029


def test_the_compared_method_reaches_the_published_disparity(papers):
    """Ten sets, of which the two worst are left out, as in the paper."""
    cameras = [as_response("srgb").f] * 10
    small_error, large_error = papers.OFF
    near = papers.without_outliers(papers.self_calibrated(cameras, off=small_error))
    far = papers.without_outliers(papers.self_calibrated(cameras, off=large_error))
    assert len(near.rmse) == 8 and near.rmse.mean() < 0.006
    assert near.disparity.mean() < far.disparity.mean() < 0.017


def test_the_variance_is_that_of_the_sets_in_square_percent(papers):
    apart = 0.01 * np.array([[1.0, 3.0], [-1.0, 3.0]])
    assert papers.variance(papers.Errors(np.zeros(2), np.zeros(2), apart)) == pytest.approx(1.0)


def test_the_spline_reads_real_responses_from_a_display(papers, cameras):
    rmse = papers.by_display(cameras[::3]).rmse  # 67 of the 201
    assert np.median(rmse) <= 0.001 and np.quantile(rmse, 0.95) <= 0.003 and rmse.max() <= 0.008


def test_the_spline_reads_real_responses_from_motion_blur(papers, cameras):
    rmse = papers.by_motion_blur(cameras[::67]).rmse  # 3 of the 201
    assert np.median(rmse) <= 0.0005 and rmse.max() <= 0.006


def test_invalid_blends_raise_an_error(tmp_path):
    line = InverseResponse(np.linspace(0.1, 0.5, 9), np.linspace(0, 1, 9), np.ones(2), np.zeros(2))
    image = np.zeros((4, 60), np.uint8)
    for call in (
        lambda: make_blend([1, 2, 3], [0.1, 0.2]),
        lambda: make_blend([1, 2, np.nan], [0.1, 0.2, 0.3]),
        lambda: make_blend([1], [0.5], low=0.9, high=0.1),
        lambda: select_blends([]),
        lambda: wilburn.join([make_blend(ALPHA, 0.5 * np.ones(15))]),
        lambda: joining.join([make_blend(ALPHA[:2], ALPHA[:2])]),
        lambda: joining.join([make_blend(ALPHA, 1 - ALPHA)]),
        lambda: joining.join(two_blends(np.sqrt), count=2),
        lambda: joining.join(two_blends(np.sqrt), ends=0.5),
        lambda: wilburn.join(two_blends(np.sqrt), degree=1),
        lambda: wilburn.join(two_blends(np.sqrt), ends=-0.1),
        lambda: display.recover_display([1, 2, 3], line),
        lambda: difference(line, line._replace(M=np.linspace(0.6, 0.9, 9))),
        lambda: ln_exposure(line, black=0.1),
        lambda: motion_blur.find_ramps(image.astype(float)),
        lambda: motion_blur.find_ramps(np.zeros((4, 60, 3), np.uint8)),
        lambda: motion_blur.find_ramps(image, low=0.5, high=0.4),
        lambda: motion_blur.compare_edges(image),
        lambda: display.mixing_ratios(3, 5, 14),
        lambda: display.draw_schedule(Schedule((300,))),
        lambda: display.draw_schedule(Schedule((100,), low=100)),
        lambda: display.draw_schedule(Schedule((100,), patch=0)),
        lambda: display.draw_schedule(Schedule((100,), border=-1)),
        lambda: display.draw_schedule(shape=(100, 100)),
        lambda: display.find_corners(np.zeros((5, 5))),
    ):
        with pytest.raises(InputError):
            call()


def test_the_whole_range_may_be_bright_and_one_side_alone_raises_an_error():
    row = np.r_[np.zeros(20), np.arange(3, 255, 6), np.full(20, 255)].astype(np.uint8)
    ramps = motion_blur.find_ramps(np.stack([row] * 4), low=0.0, high=1.0)
    assert len(ramps) == 4 and all(ramp.rises for ramp in ramps)
    with pytest.raises(ValueError, match="0 down and 4 up"):
        motion_blur.compare_edges(np.stack([row] * 4), ramps)
