"""Debevec and Malik's system: gsolve(Z, B, smoothness, w) -> g, lE. Any gauge and any solver will do."""

import numpy as np

from hdrlab.capture import responses
from hdrlab.core import weights
from hdrlab.course.checks import laws
from hdrlab.course.checks.compare import finite, parts, points, require, same
from hdrlab.fast import debevec

HAT = weights.hat()


def samples(rng, N=50, P=5, *, response=None, noise=1.0, light=(-3, 3)):
    """Return Z (N, P) and B (P,) of a camera, frames one and a half stops apart, noise in levels."""
    lE, B = rng.uniform(*light, N), 1.5 * np.log(2) * (np.arange(P) - P // 2)
    M = (response or laws.drawn_response(rng)).f(np.clip(0.2 * np.exp(lE[:, None] + B), 0, 1))
    return np.clip(np.round(255 * M + noise * rng.standard_normal(M.shape)), 0, 255).astype(int), B


def asked(subject, Z, B, smoothness, w):
    """Return g and lE of a subject, moved to the gauge g[n // 2] = 0: a constant in both is free."""
    g, lE = parts(subject.gsolve(Z, B, smoothness, w), 2, what="g and lE")
    g, lE = finite(g, (len(w),), what="g"), finite(lE, (len(Z),), what="lE")
    g, lE = g.astype(float), lE.astype(float)
    return g - g[len(w) // 2], lE - g[len(w) // 2]


def test_every_level_has_a_g_and_every_sample_an_lE(subject, rng):
    """Two things come back: g and lE.

    g has an entry for each level, lE one for each sample.

    Split the solution x at n: x[:n] and x[n:].
    """
    Z, B = samples(rng, N=40)
    asked(subject, Z, B, 30.0, HAT)


@points(4)
def test_the_curve_of_a_camera_comes_out(subject, rng):
    """Every sample in every frame gives one row, w (g(Z) - lE) = w B.

    Column Z[i, j] holds w, column n + i holds -w, and the right-hand side w B[j], B in natural
    logarithms.

    Plot g: it should rise smoothly. Steps or spikes mean that a column index is off by one.
    """
    response = laws.drawn_response(rng)
    Z, B = samples(
        rng, N=200, response=response, noise=0, light=(-2.4, 0.3)
    )  # some of them clipped
    g, _ = asked(subject, Z, B, 10.0, HAT)
    middle = np.abs(np.arange(256) - 128) < 90
    same(g, responses.true_g(response), 0.12, what="g", kind="curve", where=middle)


@points(6)
def test_g_and_lE_minimise_the_sum_of_squares(subject, rng):
    """Weights multiply whole rows: the left-hand side and the right-hand side.

    The smoothness row of level z is lambda w(z) (g(z - 1) - 2 g(z) + g(z + 1)) = 0: lambda, and
    w(z) too.

    Count your rows: N P of data, one for the gauge, n - 2 of smoothness.
    """
    Z, B = samples(rng)
    g, lE = asked(subject, Z, B, 30.0, HAT)
    truth = debevec.gsolve(Z, B, 30.0, HAT)
    same(g, truth.g, 0.02, what="g")
    same(lE, truth.lE, 0.02, what="lE")


@points(4)
def test_more_smoothness_makes_a_straighter_curve_at_the_cost_of_the_data(subject, rng):
    """What happens to your curve when the knob is turned from 1 to 300?

    The printed listing shows a digit where lambda belongs.

    Multiply every smoothness row by `smoothness`, once: a larger one makes g straighter.
    """
    Z, B = samples(rng, N=40)
    bends, misses = [], []
    for smoothness in (1.0, 10.0, 100.0, 1000.0):
        g, lE = asked(subject, Z, B, smoothness, HAT)
        bends.append(np.sum((HAT[1:-1] * np.diff(g, 2)) ** 2))
        misses.append(np.sum((HAT[Z] * (g[Z] - lE[:, None] - B)) ** 2))
    said = f"sum (w g'')^2: expected less and less as lambda grows, got {_few(bends)}"
    require(np.all(np.diff(bends) < 0) and bends[-1] < 0.03 * bends[0], said)
    said = f"sum (w (g - lE - B))^2: expected more and more as lambda grows, got {_few(misses)}"
    require(np.all(np.diff(misses) > 0), said)


def _few(numbers):
    return ", ".join(f"{one:.3g}" for one in numbers)


@points(2, needs="test_the_curve_of_a_camera_comes_out")
def test_the_order_of_the_frames_does_not_matter(subject, rng):
    """Does any line of yours look at the order of the frames?

    B[j] belongs to column j of Z, wherever that column stands.

    Do not sort Z or B by themselves.
    """
    Z, B = samples(rng, N=40)
    order = rng.permutation(len(B))
    g, _ = asked(subject, Z[:, order], B[order], 30.0, HAT)
    same(g, asked(subject, Z, B, 30.0, HAT)[0], 0.02, what="g of the frames in another order")


@points(2, needs="test_the_curve_of_a_camera_comes_out")
def test_another_unit_of_time_moves_lE_and_leaves_g_alone(subject, rng):
    """Twice the time in every frame is half the irradiance, and the same curve.

    A constant added to B must come out of lE, and leave g alone.

    The right-hand side is w B[j]: B as it is given, neither its logarithm nor its exponential.
    """
    Z, B = samples(rng, N=40)
    (g, lE), (moved, less) = (asked(subject, Z, one, 30.0, HAT) for one in (B, B + np.log(1000.0)))
    same(moved, g, 0.02, what="g with times in milliseconds")
    same(less, lE - np.log(1000.0), 0.03, what="lE with times in milliseconds")


@points(2, needs="test_the_curve_of_a_camera_comes_out")
def test_any_number_of_levels_will_do(subject, rng):
    """Is there a 256 in your code? The weights say how many levels there are.

    n = len(w); the gauge sits at level n // 2.

    The unknowns are g (n,) and then lE (N,): n + N columns.
    """
    Z, B = samples(rng, N=60, noise=0, light=(-2.2, -0.5))
    (g, _), (few, _) = (
        asked(subject, Z, B, 10.0, HAT),
        asked(subject, Z // 16, B, 1.0, weights.hat(16)),
    )
    fine = g[8::16] - g[136]  # g in the middle of each of the 16 levels
    same(
        few[4:12],
        fine[4:12],
        0.3,
        what="g of levels 4 to 11 of 16, beside yours of 256",
        kind="curve",
    )
