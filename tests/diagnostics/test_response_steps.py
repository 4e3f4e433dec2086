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


def test_a_tenth_of_the_patches_moves_the_steps_by_least_squares_and_hardly_the_robust_fit():
    def plain(H, B, Q, g):
        return response_steps.solve_steps(
            response_steps.weight_pairs(H), B, Q, g=g, sd=np.log(2) / 6, smoothness=1.0
        )

    assert np.abs(corrections(pair_tables(0.0), response_steps.fit_steps)).max() < 0.02
    moved, held = (
        np.abs(corrections(pair_tables(0.1), fit)).max() for fit in (plain, response_steps.fit_steps)
    )
    assert moved > 0.08 and held < moved / 3
