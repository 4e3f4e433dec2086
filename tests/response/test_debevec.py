"""Debevec and Malik's response: the linear system, its solution, and recovered curves."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from support import laws

from hdrlab.capture import responses
from hdrlab.core import weights
from hdrlab.course.checks.specification import test_gsolve
from hdrlab.fast import debevec as fast
from hdrlab.response import debevec

CUT = weights.cut(weights.hat())
CURVES = sorted(responses.RESPONSES)


def samples(N=40, P=5, seed=0, **arguments):
    """Return Z (N, P) and B (P,) as the specification of the task draws them: frames 1.5 stops apart."""
    return test_gsolve.samples(np.random.default_rng(seed), N, P, **arguments)


# The system


@given(st.integers(1, 9), st.integers(2, 6), st.sampled_from([16, 64, 256]))
def test_the_matrix_has_a_row_for_each_datum_one_for_the_gauge_and_one_for_each_inner_level(
    N, P, n
):
    Z = np.random.default_rng(N).integers(0, n, (N, P))
    A, b = debevec.system(Z, np.log(2.0 ** np.arange(P)), 10, weights.hat(n))
    assert A.shape == (N * P + 1 + n - 2, n + N) and b.shape == (N * P + n - 1,)


def test_the_systems_rows_are_those_of_the_paper():
    n = 8
    w = np.array([0, 1, 2, 3, 3, 2, 1, 0])
    A, b = debevec.system(np.array([[1, 3], [2, 5]]), np.array([0.5, 0.7]), 10, w)
    x = np.arange(n + 2) ** 2.0  # g and lE that are easy to tell apart
    g = x[:n]
    lE = x[n:]
    data = [
        w[1] * (g[1] - lE[0]),
        w[3] * (g[3] - lE[0]),
        w[2] * (g[2] - lE[1]),
        w[5] * (g[5] - lE[1]),
    ]
    smooth = [10 * w[z] * (g[z - 1] - 2 * g[z] + g[z + 1]) for z in range(1, n - 1)]
    assert np.allclose(A @ x, [*data, g[4], *smooth])
    assert np.allclose(b, [w[1] * 0.5, w[3] * 0.7, w[2] * 0.5, w[5] * 0.7, *[0] * (n - 1)])


@pytest.mark.parametrize(
    ("frames", "count"), [(2, 256), (4, 86), (11, 26), (12, 24), (256, 2), (257, 1)]
)
def test_samples_needed_is_the_smallest_number_that_exceeds_the_levels(frames, count):
    assert debevec.samples_needed(frames) == count
    assert count * (frames - 1) > 255 >= (count - 1) * (frames - 1)


# Its solution


@pytest.mark.parametrize("solve", [debevec.gsolve, fast.gsolve])
def test_the_solution_satisfies_the_normal_equations(solve):
    Z, B = samples()
    A, b = debevec.system(Z, B, 30, CUT)
    x = np.concatenate(solve(Z, B, 30, CUT))
    assert np.abs(A.T @ (A @ x - b)).max() < 1e-9 * np.abs(A.T @ b).max()


@pytest.mark.parametrize("solve", [debevec.gsolve, fast.gsolve])
@pytest.mark.parametrize("name", CURVES)
def test_lE_is_where_the_samples_lie_on_the_curve(name, solve):
    Z, B = samples(60, response=responses.RESPONSES[name], noise=0)
    g, lE = solve(Z, B, 1, CUT)
    error = np.where(CUT[Z] > 0.5, g[Z] - lE[:, None] - B, 0)
    assert abs(g[128]) < 1e-12
    assert np.abs(error).max() < 0.03  # half a level in the middle of a curve


def test_levels_beyond_the_cut_repeat_the_last_constrained_value():
    Z, B = samples()
    g = debevec.gsolve(Z, B, 30, CUT).g
    # the last smoothness row reaches one level beyond the cut
    reached = np.flatnonzero(CUT)[-1] + 1
    assert np.all(g[reached:] == g[reached]) and g[reached] > g[reached - 1]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"Z": [1, 2]}, r"expected levels Z \(N, P\) below 256"),
        ({"Z": [[0, 256]]}, "values 0 to 256"),
        ({"B": [0, 1, 2]}, r"got shape \(1, 2\).* and shape \(3,\)"),
        ({"Z": [[0, 255]]}, "well exposed in two photos"),
        ({"Z": [[100, 100]]}, "well exposed in two photos"),
    ],
)
def test_an_underdetermined_system_raises_an_error(changes, message):
    arguments = {"Z": [[100, 200]], "B": [0.0, 1.0], "smoothness": 10, "w": weights.hat()} | changes
    with pytest.raises(ValueError, match=message):
        debevec.gsolve(**arguments)


def test_recover_finds_the_response_of_a_simulated_camera(seven_frames):
    _, taken = seven_frames("film")
    g = debevec.recover(taken.images, taken.times, samples=60)
    assert laws.curve_error(g, responses.true_g("film")) < 0.01 and np.all(np.diff(g) >= 0)


def test_straighten_toe_makes_the_response_linear_below_the_first_weighted_level():
    w = weights.cut(weights.hat(), below=0.05)
    first = int(np.argmax(w > 0))
    exposures = np.exp(debevec.straighten_toe(responses.true_g("film")[:, None], w)[: first + 1, 0])
    steps = np.diff(exposures)
    assert first > 3 and np.allclose(steps, steps[0], rtol=1e-9)
    assert np.isclose(exposures[0], steps[0] / 2, rtol=1e-9)
