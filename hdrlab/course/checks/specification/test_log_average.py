"""Checks of log_average(L), the overall brightness of a scene: Lav."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, require, same


def draw_inputs(rng):
    return np.exp(1.5 * rng.standard_normal((40, 50))).astype(np.float32)


def is_valid_input(L, **_):
    """Return whether there is any light, and so a median."""
    return bool((L > 0).any())


def test_a_scene_has_one_average(subject, rng):
    """Return one number for the whole image.

    Do not return one number per row.

    Use np.mean without an axis.
    """
    finite(subject.log_average(draw_inputs(rng) + np.float32(1)), (), what="Lav")


@points(6)
def test_it_is_the_geometric_mean(subject, rng):
    """One lamp must not change the average of the whole scene much.

    Take the mean of the logarithms, not the logarithm of the mean.

    exp(mean(log(delta + L))). The factor 1 / N belongs inside exp; the paper prints it outside.
    """
    L = draw_inputs(rng)
    lit = np.where(np.arange(L.size).reshape(L.shape) == 154, np.float32(1e6), L)  # one lamp
    for luminance, what in ((L, "ln Lav"), (lit, "ln Lav with a lamp")):
        answer = finite(subject.log_average(luminance), (), what="Lav")
        same(np.log(answer), np.log(luminance, dtype=float).mean(), 1e-3, what=what)


@points(2, needs="test_it_is_the_geometric_mean")
def test_black_pixels_leave_it_finite_and_above_0(subject, rng):
    """What is log 0?

    Add a small delta, so that black has a finite logarithm.

    Use log(delta + L), with delta inside the logarithm.
    """
    L = draw_inputs(rng)
    L[:4] = 0
    answer = float(finite(subject.log_average(L), (), what="Lav"))
    message = (
        f"Lav: expected a value above 0 and below that without the black pixels, got {answer:.4g}"
    )
    require(0 < answer < 0.9 * np.exp(np.log(L[4:], dtype=float).mean()), message)


@points(2, needs="test_it_is_the_geometric_mean")
def test_ten_times_the_light_gives_ten_times_the_average(subject, rng):
    """Make the scene ten times as bright. How should Lav change?

    Lav has the same unit as L, so it must become ten times as large.

    Do not forget exp at the end.
    """
    L = draw_inputs(rng)
    average = float(finite(subject.log_average(L), (), what="Lav"))
    brighter = float(finite(subject.log_average(L * np.float32(10)), (), what="Lav"))
    same(brighter / average, 10.0, 0.01, what="Lav of 10 L / Lav of L")


@points(2, needs="test_it_is_the_geometric_mean")
def test_delta_is_given_in_medians(subject, rng):
    """The scene is in another unit, a thousand times larger. Is the same delta added?

    No. `delta` is a share of the median, so it grows with L.

    delta * np.median(L[L > 0]): black pixels do not count in this median.
    """
    L = draw_inputs(rng) * np.float32(10.0 ** rng.choice([-3, 3]))
    L[:15] = 0
    delta = float(rng.uniform(0.1, 0.4))
    added = delta * float(np.median(L[L > 0]))
    expected = np.log(added + L.astype(float)).mean()
    answer = finite(subject.log_average(L, delta=delta), (), what="Lav")
    require(answer > 0, f"Lav: expected a value above 0, got {float(answer):.4g}")
    same(np.log(answer), expected, 1e-3, what="ln Lav with a large delta")
