"""The examples that an assignment calculates by hand agree with hdrlab's functions."""

import numpy as np
import pytest

from hdrlab.align import cerman
from hdrlab.beyond import assorted, flutter
from hdrlab.beyond.burst import temporal_merge
from hdrlab.calibration import wilburn
from hdrlab.enhance import battiato, relight, skin
from hdrlab.radiance import flare, scales
from hdrlab.response import mann, space
from hdrlab.tonemap import brush

PEAK_IN_A_CORNER = np.full((3, 5), -1.0)
PEAK_IN_A_CORNER[0, 4] = 1
SPOT = np.zeros((5, 5))
SPOT[2, 2] = 100
BLEND = (np.array([0.0, 1, 2]), np.array([0.0, 1, 4]) / 4)

# the task, its answer, and what the sheet of homework 6 calculates
EXAMPLES = {
    "fit_channel_scales": (
        scales.fit_channel_scales([[0.1, 0.8, 0.2]], [[0.2, 0.4, 0.4]]),
        [4, 1, 4],
    ),
    "descend": (mann.descend(np.arange(256) / 2, 200, low=20), [200, 100, 50, 25]),
    "fit_exponent": (mann.fit_exponent([(np.array([200.0, 100, 50]), 1 / 4)]), 1 / 2),
    "peaks": (cerman.peaks(PEAK_IN_A_CORNER, 3), [[-1, 2]]),
    "offset": (relight.offset(127.5, 191.25, a=1, c=1), np.log(3)),
    "table": (relight.table(np.log(3), a=1, c=1)[85], 153),
    "subtract_glare": (
        flare.subtract_glare(np.ones((1, 2), np.float32), np.array([[2, 6]], np.float32), 0.2),
        [[0.75, 0.00125]],
    ),
    "reconstruct": (
        assorted.reconstruct(np.array([[65535, 32768]], np.uint16), [[1, 1 / 4]]),
        [[2, 2]],
    ),
    "smear": (flutter.smear([4, 8], [1, 0, 1, 1]), [1, 2, 1, 3, 2]),
    "sharpen": (flutter.sharpen([1, 2, 1, 3, 2], [1, 0, 1, 1]), [4, 8]),
    "fit_space, mean": (space.fit_space([[0, 1], [0, 3]], 1).mean, [0, 2]),
    "fit_space, H": (np.abs(space.fit_space([[0, 1], [0, 3]], 1).H), [[0, 1]]),
    "fit_space, sd": (space.fit_space([[0, 1], [0, 3]], 1).sd, [1]),
    "solve_map": (space.solve_map(np.ones((1, 1)), np.array([3.0]), np.ones(1)), [1.5]),
    "quadratic_form": (wilburn.quadratic_form([BLEND], 1), [[0, 0], [0, 1 / 24]]),
    "clip_histogram": (
        brush.clip_histogram(np.array([0.7, 0.3, 0, 0]), limit=2),
        [0.5, 0.3 + 0.2 / 6, 0.5 / 6, 0.5 / 6],
    ),
    "contrast": (battiato.contrast(np.full((4, 4), 100.0)), 1.2),
    "focus, with little noise": (battiato.focus(SPOT, noise=20), 32),
    "focus, with much noise": (battiato.focus(SPOT, noise=150), 16),
    "merge_tile": (
        temporal_merge.merge_tile(np.array([[[3.0]], [[1.0]]]), 1.0, tuning=1.0),
        [[8 / 3]],
    ),
    "find_by_locus": (skin.find_by_locus([[224, 172, 105], [60, 90, 200]]), [True, False]),
}


@pytest.mark.parametrize("name", EXAMPLES)
def test_the_library_answers_what_the_assignment_calculates_by_hand(name):
    answer, by_hand = EXAMPLES[name]
    np.testing.assert_allclose(answer, by_hand, rtol=1e-4, atol=1e-12)
