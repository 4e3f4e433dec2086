"""Checks of recover_steps(Z, times, w), Robertson's iterations: the first part of each state is
f^-1 (256,).
"""

import numpy as np
from scipy.ndimage import gaussian_filter1d

from hdrlab.capture import responses
from hdrlab.core import weights
from hdrlab.course.checks import laws
from hdrlab.course.checks.compare import finite, points, require, same, states
from hdrlab.response import robertson

W = weights.cut(weights.gaussian(), below=0.02)
SHOWN = slice(12, 245)


def samples(rng, response, N=900, P=6):
    """Return Z (N, P) and t (P,) of a camera, with frames one stop apart and no noise except
    rounding.
    """
    E = 2.0 ** (10 * (np.arange(N) + rng.random(N)) / N - 5)  # even over ten stops
    t = 2.0 ** (np.arange(P) - P // 2)
    M = response.f(np.clip(0.2 * E[:, None] * t, 0, 1))
    return np.clip(np.round(255 * M), 0, 255).astype(int), t


def same_curve(f, truth, tolerance):
    """Compare at levels 12 to 244, smoothed, because a level that only a few pixels have is
    inexact.
    """
    f, truth = (gaussian_filter1d(curve, 3)[SHOWN] for curve in (f, truth))
    same(f, truth, tolerance * truth[-1], what="f^-1 at levels 12 to 244", kind="curve")


def get_answer(subject, Z, t, **options):
    """Return f^-1 of every state divided by f^-1(128), because its scale is free."""
    answer = states(subject.recover_steps(Z, t, W, **options), what="the states")
    curves = []
    for state in answer:
        curve = state[0] if isinstance(state, tuple | list) else state
        f = finite(curve, (256,), what="f^-1").astype(float)
        require(f[128] > 0, f"f^-1: expected values above 0, got {f[128]:.3g} at level 128")
        curves.append(f / f[128])
    return curves


# right iterations may differ in their steps, which small inputs show most
check_one_input = None


@points(5)
def test_the_iterations_converge_to_the_curve_of_the_camera(subject, rng):
    """Plot f^-1 after every iteration. Does it approach the curve of the camera?

    One iteration computes E from f^-1, then f^-1 from E, and then divides f^-1 by its value at 128.

    Iterate until f^-1 hardly changes. About thirty iterations are enough.
    """
    # the line is far from it
    for response in (
        laws.drawn_response(rng),
        responses.RESPONSES["gamma"],
    ):
        Z, t = samples(rng, response, N=2000)
        f = get_answer(subject, Z, t, max_iterations=25)[-1]
        truth = np.exp(responses.true_g(response))
        scale = np.sum(f[SHOWN] * truth[SHOWN]) / np.sum(f[SHOWN] ** 2)
        same_curve(scale * f, truth, 0.02)


@points(3)
def test_an_iteration_is_a_weighted_mean_followed_by_a_plain_one(subject, rng):
    """An iteration computes two means, one after the other. Which of them has weights?

    The irradiance is a weighted mean. The new f^-1(m) is the plain mean of E t over the pixels of
    value m.

    Do not use weights in the update: all its pixels have the same pixel value.
    """
    Z = rng.integers(15, 250, (900, 4)).astype(np.intp)
    t = rng.uniform(0.2, 1, 4)
    line = np.arange(256) / 128
    levels = slice(15, 249)
    truth = robertson.update(Z, t, robertson.irradiance(Z, t, line, W))
    curves = get_answer(subject, Z, t, max_iterations=3, tolerance=0.0)
    message = f"expected a state before the first iteration and one after each, got {len(curves)}"
    require(len(curves) >= 2, message)
    expected = truth[levels] / truth[128]
    same(curves[1][levels], expected, 0.01, what="f^-1 after the first iteration", kind="curve")


@points(3, needs="test_the_iterations_converge_to_the_curve_of_the_camera")
def test_a_correct_curve_does_not_change(subject, rng):
    """For a linear camera, the initial guess is already correct. What should the iterations change?

    Nothing. Start with a line, not with an exponential.

    The initial guess is f^-1(m) = m / 128, which is 1 at pixel value 128.
    """
    x = np.union1d(rng.permutation(np.arange(5, 62))[:45], 32)  # 4 x 32 = 128, where f^-1 is 1
    Z = np.stack([x, 2 * x, 4 * x], axis=1)
    t = np.array([1.0, 2.0, 4.0])
    levels = np.unique(Z)
    truth = np.where(np.isin(np.arange(256), levels) & (W > 0), np.arange(256) / 128, np.nan)
    for f in get_answer(subject, Z, t, max_iterations=5):
        same(f, truth, 2e-3, what="f^-1 of a linear camera", kind="curve", where=~np.isnan(truth))


@points(3, needs="test_the_iterations_converge_to_the_curve_of_the_camera")
def test_levels_without_pixels_are_filled_by_interpolation(subject, rng):
    """Some pixel values have no pixels. What is their mean?

    It is 0 / 0, which is NaN. One NaN spoils every sum of the next iteration.

    Interpolate the empty pixel values: use np.interp over the pixel values that have pixels.
    """
    Z, t = samples(rng, laws.drawn_response(rng))
    all_levels = get_answer(subject, Z, t, max_iterations=12)[-1]
    even_levels = get_answer(subject, Z // 2 * 2, t, max_iterations=12)[-1]
    same_curve(even_levels, all_levels, 0.05)


@points(2)
def test_each_iteration_yields_a_state_and_changes_the_curve_less(subject, rng):
    """Yield a state before the first iteration, and one after each iteration.

    Use a new array for each state. If you change one array in place, all states show the last
    curve.

    The changes must become smaller from one iteration to the next.
    """
    Z, t = samples(rng, laws.drawn_response(rng))
    curves = get_answer(subject, Z, t, max_iterations=8, tolerance=0.0)
    changes = [float(np.abs(b - a)[SHOWN].max()) for a, b in zip(curves, curves[1:], strict=False)]
    message = (
        f"expected 9 states with ever smaller changes, got {len(curves)} with changes of {changes}"
    )
    require(len(curves) >= 8 and 0 < changes[-1] < 0.5 * changes[0], message)


@points(2, needs="test_the_iterations_converge_to_the_curve_of_the_camera")
def test_the_unit_of_time_does_not_matter(subject, rng):
    """The photos do not show whether the times are in seconds or milliseconds.

    If all times are 1000 times as long, E becomes a thousandth, and f^-1 does not change.

    Divide f^-1 by its value at 128 at the end of every iteration.
    """
    Z, t = samples(rng, laws.drawn_response(rng))
    in_seconds = get_answer(subject, Z, t, max_iterations=6)[-1]
    in_milliseconds = get_answer(subject, Z, 1000.0 * t, max_iterations=6)[-1]
    same_curve(in_milliseconds, in_seconds, 0.005)


@points(1, needs="test_each_iteration_yields_a_state_and_changes_the_curve_less")
def test_tolerance_and_max_iterations_end_it(subject, rng):
    """When do your iterations end?

    After the first iteration in which f^-1 changes by less than `tolerance` everywhere, and after
    `max_iterations` at the latest.

    Do not write numbers of your own in their place.
    """
    Z, t = samples(rng, laws.drawn_response(rng), N=300)
    for options, last_iteration in (
        ({"tolerance": 1e9}, 1),
        ({"tolerance": 0.0, "max_iterations": 3}, 3),
    ):
        count = len(get_answer(subject, Z, t, **options))
        message = f"expected at most {last_iteration + 1} states with {options}, got {count}"
        require(count <= last_iteration + 1, message)
