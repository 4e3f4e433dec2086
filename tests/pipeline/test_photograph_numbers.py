"""What the functions that make a picture of a map answer to some input, written down: `recorded`."""

from functools import partial as of

import numpy as np
import pytest
import recorded
from scipy.ndimage import gaussian_filter

from hdrlab.pipeline import photograph, pictures, screens

RNG = np.random.default_rng(53)
E = gaussian_filter(RNG.lognormal(0, 2, (61, 83, 3)), (2, 2, 0)).astype(np.float32)
L = E[..., 1].copy()
HOLES = L * (L > 0.1)
LL = np.log10(L)
SETTINGS = photograph.choose_settings(E)
KNOBS = {"share": 0.7, "key": 0.2, "white": 3.0, "black": 0.01}
LINES = photograph.filter_light(LL)
PICTURE = RNG.integers(0, 256, (61, 83, 3), np.uint8)
CASES = recorded.named(
    *(of(photograph.choose_settings, e) for e in (E, L, HOLES, L * 0 + 1, L * 0, L[:1, :1], E[:3, :2],
        E**3, L**6, E * (L > np.median(L))[..., None] / 99, np.kron(L, np.ones((12, 9), np.float32)))),
    *(of(photograph.filter_light, a) for a in (LL, LL[:1], LL[:, :5], LL[:4, :5], np.kron(LL, np.ones((2, 3),
        np.float32)))),
    *(of(photograph.draw_lines, *a) for a in ((5, 3, 2), (7, 3, 4), (4, 4, 1))),
    *(of(photograph.compress_light, LL, s, *LINES) for s in (1, 0.5)),
    *(of(photograph.find_levels, a) for a in (LL, np.kron(LL, np.ones((12, 9), np.float32)))),
    *(of(photograph.scale, a, -0.2, 0.2) for a in (LL, LL * 99)),
    *(of(photograph.photograph, a, **KNOBS) for a in (L, L / 50, HOLES, L * 0, np.kron(L, np.ones((12, 9),
        np.float32)))),
    *(of(photograph.photograph, L, **KNOBS | {k: v}) for k, v in (("share", 0), ("share", 1), ("share", 1.1),
        ("key", 0), ("white", 0), ("white", 0.5), ("black", -0.1), ("black", 0), ("black", 1), ("key", "a"))),
    *(of(pictures.develop_and_describe, e, *a, **k) for e, a, k in ((E, (), {}), (L, (), {}), (E,
        ("reinhard",), {"key": 0.3}), (E, ("fattal",), {}), (E, (), {"saturation": 0.5, "way": "ratio",
        "key": 0.4}), (E, (lambda L: L / (1 + L),), {}))),
    of(pictures.develop, E, "curves"),
    *(of(screens.signal, E, **k) for k in ({}, {"primaries": "p3"})),
    *(of(screens.light, PICTURE, e, **k) for e, k in ((E, {}), (L, {"headroom": 2.0}))),
)  # fmt: skip


@pytest.mark.parametrize("function", CASES)
def test_the_same_numbers_come_for_the_same_input(function):
    recorded.check(CASES, function, __file__, 1e-5)
