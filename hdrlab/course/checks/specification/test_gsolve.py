"""Checks of gsolve(Z, B, smoothness, w), Debevec and Malik's system: g and lE. Any gauge and any
solver are accepted.
"""

import numpy as np

from hdrlab.capture import responses
from hdrlab.core import weights
from hdrlab.course.checks import laws
from hdrlab.course.checks.compare import finite, parts, points, require, same
from hdrlab.fast import debevec

HAT = weights.hat()


def samples(rng, N=50, P=5, *, response=None, noise=1.0, light=(-3, 3)):
    """Return Z (N, P) and B (P,) of a camera, with frames 1.5 stops apart and noise in levels."""
    lE = rng.uniform(*light, N)
    B = 1.5 * np.log(2) * (np.arange(P) - P // 2)
    M = (response or laws.drawn_response(rng)).f(np.clip(0.2 * np.exp(lE[:, None] + B), 0, 1))
    return np.clip(np.round(255 * M + noise * rng.standard_normal(M.shape)), 0, 255).astype(int), B


def as_on_the_sheet(B, smoothness, w):
    """Return ln t, lambda and w as the sheet passes them. Variants of the task change this."""
    exposures = B
    strength = smoothness
    table = w
    return exposures, strength, table


def from_the_sheet(exposures, strength, table):
    """Return ln t, lambda and w of arguments that `as_on_the_sheet` returns."""
    B = exposures
    smoothness = strength
    w = table
    return B, smoothness, w


def get_answer(subject, Z, B, smoothness, w):
    """Return g and lE of a subject for the ln times B, as `in_gauge` shifts them."""
    return in_gauge(subject.gsolve(Z, *as_on_the_sheet(B, smoothness, w)), len(w), len(Z))


def in_gauge(answer, n, N):
    """Return g (n,) and lE (N,), shifted to g[n // 2] = 0, because a constant in both is free."""
    g, lE = parts(answer, 2, what="g and lE")
    g = finite(g, (n,), what="g")
    lE = finite(lE, (N,), what="lE")
    g = g.astype(float)
    lE = lE.astype(float)
    return g - g[n // 2], lE - g[n // 2]


# in both, the curve bends, and there are more equations than unknowns, so that every weight counts
SMALL_INPUTS = [
    (np.array([[0, 1], [0, 2]]), np.array([0.0, 2.0]), 0.5, np.array([1.0, 2.0, 3.0])),
    (np.array([[0, 1], [2, 3]]), np.array([0.0, 2.0]), 0.5, np.array([1.0, 2.0, 3.0, 1.0])),
]


def check_one_input(subject, Z, exposures, strength, table):
    """Compare g and lE with those of the solution."""
    n = len(table)
    g, lE = in_gauge(subject.gsolve(Z, exposures, strength, table), n, len(Z))
    truth = debevec.gsolve(Z, *from_the_sheet(exposures, strength, table))
    gauge = truth.g[n // 2]
    same(g, truth.g - gauge, 0.02, what="g")
    same(lE, truth.lE - gauge, 0.02, what="lE")


def test_every_level_has_a_g_and_every_sample_an_lE(subject, rng):
    """Return two arrays: g and lE.

    g has one value per pixel value, and lE has one per sample.

    Split the solution x at n: g = x[:n] and lE = x[n:].
    """
    Z, B = samples(rng, N=40)
    get_answer(subject, Z, B, 30.0, HAT)


@points(4)
def test_the_curve_of_a_camera_is_recovered(subject, rng):
    """Each sample gives one row for each photo: w (g(Z) - lE) = w B.

    Column Z[i, j] holds w, column n + i holds -w, and the right-hand side is w B[j]. B is a natural
    logarithm.

    Plot g: it must rise smoothly. Steps or spikes mean that a column index is off by one.
    """
    response = laws.drawn_response(rng)
    # some of them clipped
    Z, B = samples(rng, N=200, response=response, noise=0, light=(-2.4, 0.3))
    g, _ = get_answer(subject, Z, B, 10.0, HAT)
    middle = np.abs(np.arange(256) - 128) < 90
    same(g, responses.true_g(response), 0.12, what="g", kind="curve", where=middle)


@points(6)
def test_g_and_lE_minimize_the_sum_of_squares(subject, rng):
    """Multiply whole rows by the weight: the left-hand side and the right-hand side.

    The smoothness row of pixel value z is lambda w(z) (g(z - 1) - 2 g(z) + g(z + 1)) = 0. It has
    both factors, lambda and w(z).

    Count your rows: N P for the data, one for the gauge, n - 2 for smoothness.
    """
    Z, B = samples(rng)
    g, lE = get_answer(subject, Z, B, 30.0, HAT)
    truth = debevec.gsolve(Z, B, 30.0, HAT)
    same(g, truth.g, 0.02, what="g")
    same(lE, truth.lE, 0.02, what="lE")


@points(4)
def test_more_smoothness_gives_a_straighter_curve_and_a_worse_fit(subject, rng):
    """What happens to your curve when you raise `smoothness` from 1 to 300?

    What looks like the digit 1 in the printed listing is the letter l, for lambda.

    Multiply every smoothness row by `smoothness`, once. A larger value makes g straighter.
    """
    Z, B = samples(rng, N=40)
    bends = []
    misses = []
    for smoothness in (1.0, 10.0, 100.0, 1000.0):
        g, lE = get_answer(subject, Z, B, smoothness, HAT)
        bends.append(np.sum((HAT[1:-1] * np.diff(g, 2)) ** 2))
        misses.append(np.sum((HAT[Z] * (g[Z] - lE[:, None] - B)) ** 2))
    message = f"sum (w g'')^2: expected it to decrease as lambda grows, got {_few(bends)}"
    require(np.all(np.diff(bends) < 0) and bends[-1] < 0.03 * bends[0], message)
    message = f"sum (w (g - lE - B))^2: expected it to increase as lambda grows, got {_few(misses)}"
    require(np.all(np.diff(misses) > 0), message)


def _few(numbers):
    return ", ".join(f"{number:.3g}" for number in numbers)


@points(2, needs="test_the_curve_of_a_camera_is_recovered")
def test_the_order_of_the_frames_does_not_matter(subject, rng):
    """Does your code depend on the order of the frames?

    B[j] belongs to column j of Z, in any order.

    Do not sort Z without B, or B without Z.
    """
    Z, B = samples(rng, N=40)
    order = rng.permutation(len(B))
    g, _ = get_answer(subject, Z[:, order], B[order], 30.0, HAT)
    same(
        g, get_answer(subject, Z, B, 30.0, HAT)[0], 0.02, what="g with the frames in another order"
    )


@points(2, needs="test_the_curve_of_a_camera_is_recovered")
def test_another_unit_of_time_changes_lE_but_not_g(subject, rng):
    """Twice the time in every frame means half the irradiance and the same curve.

    If you add a constant to B, lE must decrease by this constant, and g must not change.

    The right-hand side is w B[j]. Use B as it is, not its logarithm or its exponential.
    """
    Z, B = samples(rng, N=40)
    g, lE = get_answer(subject, Z, B, 30.0, HAT)
    g_ms, lE_ms = get_answer(subject, Z, B + np.log(1000.0), 30.0, HAT)
    same(g_ms, g, 0.02, what="g with times in milliseconds")
    same(lE_ms, lE - np.log(1000.0), 0.03, what="lE with times in milliseconds")


@points(2, needs="test_the_curve_of_a_camera_is_recovered")
def test_any_number_of_levels_works(subject, rng):
    """Is there a 256 in your code? The length of w is the number of pixel values.

    n = len(w), and the gauge is at pixel value n // 2.

    The unknowns are g (n,) followed by lE (N,): n + N columns.
    """
    Z, B = samples(rng, N=60, noise=0, light=(-2.2, -0.5))
    g, _ = get_answer(subject, Z, B, 10.0, HAT)
    few, _ = get_answer(subject, Z // 16, B, 1.0, weights.hat(16))
    fine = g[8::16] - g[136]  # g in the middle of each of the 16 levels
    same(
        few[4:12],
        fine[4:12],
        0.3,
        what="g of levels 4 to 11 of 16, compared with your g of 256 levels",
        kind="curve",
    )
