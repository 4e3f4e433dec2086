"""Steps between frames by least squares over pair tables, made up so that their answer is known."""

import numpy as np

from hdrlab.diagnostics import response_steps

B = np.log([1 / 64, 1 / 16, 1 / 4, 1.0])
g = np.log(np.linspace(1e-3, 1, 256))  # a camera of straight lines


def pair_tables(wrong):
    """Return pair tables of many patches, of which a share shows a frame that is a stop too dark."""
    H = np.zeros((3, 1, 256, 256))
    for j, step in enumerate(np.diff(B)):
        for a in range(20, 60):
            for missed, patches in ((0, 1 - wrong), (-np.log(2), wrong)):
                b = int(np.abs(g - (g[a] + step + missed)).argmin())
                H[j, 0, a, b] += 10 * patches
    return H


def corrections(H, fit):
    return fit(H, B, response_steps.free_directions(B, known=True), g=g[None]).x / np.log(2)


def test_a_tenth_of_outliers_shifts_the_robust_fit_much_less_than_least_squares():
    def plain(H, B, Q, g):
        return response_steps.solve_steps(
            response_steps.weight_pairs(H), B, Q, g=g, sd=np.log(2) / 6, smoothness=1.0
        )

    assert np.abs(corrections(pair_tables(0.0), response_steps.fit_steps)).max() < 0.02
    moved, held = (
        np.abs(corrections(pair_tables(0.1), fit)).max()
        for fit in (plain, response_steps.fit_steps)
    )
    assert moved > 0.08 and held < moved / 3


def test_the_normal_equations_agree_with_lstsq_on_one_equation_per_patch():
    H, sd, C = pair_tables(0.1), np.log(2) / 6, response_steps.WEIGHTED_CURVATURES
    V, Q = response_steps.weight_pairs(H), response_steps.free_directions(B)
    found = response_steps.solve_steps(V, B, Q, sd=sd, smoothness=1.0)
    unit, F, k = (
        np.sqrt(response_steps.MAX_PATCHES_PER_PAIR) / response_steps.STEP_ERROR_LN,
        np.diff(Q, axis=0),
        np.arange(len(V.V)),
    )
    patches = np.zeros((len(k), 256 + Q.shape[1]))  # sqrt V (g(b) - g(a) - F y) = sqrt V step
    np.add.at(patches, (k, V.b), 1)
    np.add.at(patches, (k, V.a), -1)
    patches[:, 256:] = -F[V.j]
    smooth, prior = np.zeros((len(C), patches.shape[1])), np.zeros((Q.shape[1], patches.shape[1]))
    smooth[:, :256], prior[:, 256:], gauge = (
        unit * C,
        np.eye(Q.shape[1]) / sd,
        unit * np.eye(len(prior[0]))[[128]],
    )
    A = np.vstack([np.sqrt(V.V)[:, None] * patches, smooth, prior, gauge])
    right = np.concatenate([np.sqrt(V.V) * np.diff(B)[V.j], np.zeros(len(A) - len(k))])
    solution = np.linalg.lstsq(A, right)[0]
    trusted = np.unique([V.a, V.b])
    assert np.abs(found.x - Q @ solution[256:]).max() < 1e-5
    assert np.abs((found.g[0] - solution[:256])[trusted]).max() < 1e-3


def test_two_lines_that_explain_the_errors_of_times_equally_well_are_both_listed():
    """By the first and the third time, the other two are wrong; or the other way round."""
    B = np.arange(4.0)
    lines = response_steps.list_trends(np.array([-2.0, -2.0, -1.0, 1.0]), B, margin=1.1)
    assert any(np.allclose(line, [0, -0.5, 0, 1.5]) for line in lines)
    assert any(np.allclose(line, [1.5, 0, -0.5, 0]) for line in lines)
    (alone,) = response_steps.list_trends(np.array([0.0, 0.0, 0.0, 1.0]), B, margin=1.1)[:1]
    assert np.allclose(alone, [0, 0, 0, 1])
