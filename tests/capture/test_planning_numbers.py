"""What the functions of `capture.planning` answer to some input, written down: `recorded`."""

from functools import partial as of

import numpy as np
import pytest
import recorded

from hdrlab.capture import exposure, planning

INF, NAN = np.inf, np.nan
MODEL = planning.Model(converter_noise=2.0, speeds=(100.0, 400.0))
T, S = np.array([0.01, 0.1, 1.0]), np.array([100.0, 400.0, 100.0])


def planned(*args):
    """Return how many photographs a plan has, and how long they take; of two as long, either may come."""
    found = planning.plan_by_noise(*args)
    return len(found.times), found.times.sum()


planned.__module__ = "hdrlab.capture.planning"
CASES = recorded.named(
    *(of(planning.count, s, u, o) for s, u, o in ((7, 7, 3), (7.1, 7, 3), (11, 7, 3), (11.01, 7, 3), (2, 7,
        3), (20, 5, 1))),
    *(of(planning.plan, lo, hi, **k) for lo, hi, k in ((1, 1000, {}), (0.5, 3e4, {"per_stop": 3,
        "overlap": 2.5}), (3, 3, {}), (1, 1e4, {"aperture": 4.0, "iso": 400.0}), (0.01, 99,
        {"usable": 5.0}))),
    *(of(planning.plan, lo, hi, **k) for lo, hi, k in ((0, 1, {}), (2, 1, {}), (1, INF, {}), (1, 2,
        {"usable": 3.0}), (1, 2, {"overlap": -0.1}), (1, 2, {"usable": INF}), (1, 2, {"usable": 3.5}), (1, 9,
        {"overlap": 0, "usable": 1.0}))),
    *(of(planning.around, m, 2.0 ** np.arange(-6, 4), n, s) for m, n, s in ((0.1, 3, 2), (8, 3, 1), (2**-6,
        4, 1), (0.3, 2, 3), (1, 11, 1), (1, 5, 0.4))),
    of(planning.squared_snr, [0.1, 10, 500, 7680], T, S, planning.Model()),
    of(planning.squared_snr, [0.1, 10, 500], T, S, MODEL),
    of(planning.squared_snr, [0.1, 10, 500], T, S, MODEL._replace(converter_noise=3.0)),
    *(of(planning._name, t, exposure.shutter_series()) for t in (64, 1.55, 2**-15, 2**-6, 2**-5.985)),
    *(of(planning.settings, 0.5, 400, snr, m) for snr in (10, 200) for m in (planning.Model(), MODEL)),
    of(planning.hardest, 0.5, 3000.0, T, S, MODEL),
    of(planning.hardest, 19.2, 768, T, np.full(3, 400.0), planning.Model()),
    of(planning.worst_snr, 0.5, 700, T, S, MODEL),
    *(of(planned, lo, hi, snr, *m) for lo, hi, snr, m in ((1, 500, 10, ()), (0.5, 3000, 20,
        (MODEL,)), (1, 1, 5, ()), (0, 1, 5, ()), (2, 1, 5, ()), (1, 2, 0, ()), (1, INF, 5, ()))),
    *(of(planned, 1, 9, 10, planning.Model(**{k: v})) for k, v in (("full_well", 0), ("gain",
        0), ("read_noise", -1), ("converter_noise", -1), ("pause", -1), ("pause", INF), ("pause", 0))),
)  # fmt: skip


@pytest.mark.parametrize("function", CASES)
def test_the_same_numbers_come_for_the_same_input(function):
    recorded.check(CASES, function, __file__)
