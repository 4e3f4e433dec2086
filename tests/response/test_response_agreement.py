"""The curves and radiance maps of different methods agree, and bad brackets never give NaN."""

from itertools import combinations

import numpy as np
import pytest

from hdrlab.capture import camera
from hdrlab.core import weights
from hdrlab.core.metrics import response_rmse
from hdrlab.fast import debevec
from hdrlab.fast.merge import merge
from hdrlab.pipeline import recovery
from hdrlab.response import grossberg, mann, marginal, space

pytestmark = pytest.mark.papers

FREE = {
    "debevec": debevec.recover,
    "robertson": recovery.find_method("robertson"),
    "histograms": grossberg.recover,
}
FORMULAS = {
    "polynomial": recovery.find_method("mitsunaga"),  # of the order that it chooses
    "likelihood": marginal.recover,
    "space": space.recover,
    "power law": mann.recover,
}
ALL = FREE | FORMULAS


@pytest.mark.parametrize(
    ("name", "limit", "apart"),
    [("window", 1.5, 0.1), ("frobisher", 3, 0.1), ("stlouis_arch", 8, 0.1)],
)
def test_on_real_brackets_curves_and_maps_agree(name, limit, apart, photographs):
    """Curves agree within percents of the top exposure, and maps within a tenth of a stop after scaling
    each channel. The night scene has little blue light near the top, so there its curves differ
    most.
    """
    taken = photographs(name)
    step = max(1, taken.images.shape[1] // 400)
    images = taken.images[:, ::step, ::step]
    g = {method: recover(images, taken.times) for method, recover in ALL.items()}
    maps = {
        method: np.log2(merge(images, taken.times, curve, weights.gaussian()))
        for method, curve in g.items()
    }
    for a, b in combinations(ALL, 2):
        off = maps[a] - maps[b]
        assert np.median(np.abs(off - np.median(off, axis=(0, 1)))) < apart, (a, b)
        if a in FREE and b in FREE:
            assert response_rmse(g[a], g[b]).max() < limit, (a, b)


@pytest.mark.parametrize("method", ALL)
@pytest.mark.parametrize(
    "case", ["times wrong by 100", "frames in the wrong order", "frames alike", "noise alone"]
)
def test_contradictions_give_a_finite_rising_curve_or_a_clear_error(method, case, decades):
    E = decades((60, 80))
    taken = camera.shoot(E, camera.times_around(E, 4, stops=2))
    images, times = {
        "times wrong by 100": (taken.images, taken.times * [1, 100, 1, 100]),
        "frames in the wrong order": (taken.images[::-1], taken.times),
        "frames alike": (taken.images[[1, 1, 1, 1]], taken.times),
        "noise alone": (
            np.random.default_rng(0).integers(0, 256, (4, 60, 80)).astype(np.uint8),
            taken.times,
        ),
    }[case]
    try:
        g = ALL[method](images, times)
    except ValueError as error:
        assert "expected" in str(error)
    else:
        assert np.all(np.isfinite(g)) and np.all(np.diff(g) >= 0) and g[128] == 0
