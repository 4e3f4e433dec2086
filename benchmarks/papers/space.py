"""Experiments on the space of responses, with curves that were measured (Grossberg and Nayar 2003).

curves  brightness over exposure (C, n), both 0 to 1
RMS     of a curve less its like, over exposure
near    RMS below which two curves count as copies: a prior holds none of the curve that it is tried on

Samples are read with noise of 0.001, seed 0.
"""

import re
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from benchmarks.experiments import Experiment, at_most, measured_curves, real, spread
from hdrlab.calibration.chart import NEUTRAL
from hdrlab.response import space

Float = NDArray[np.float64]
# the chart's grays but black: as exposures, where white is at 0.9 of the range
PLACES = NEUTRAL[:5]
EMOR = "RMS with 3, 5, 11 published components"
OURS = "RMS with 3, 5, 11 components of ours"
SAMPLES = "RMS of a response from 5 samples, mean, %"


def read_emor(path: Path) -> space.Space:
    """Return the published components: blocks, `name =` and numbers: the axis, the mean, the components."""
    parts = re.split(
        r"^\s*\w+(?:\(\d+\))?\s*=", path.read_text(encoding="latin-1"), flags=re.MULTILINE
    )
    blocks = [np.array(numbers.split(), np.float64) for numbers in parts[1:]]
    mean = blocks[1]
    components = blocks[2:]
    return space.Space(mean, np.stack(components), np.ones(len(components)))


def rms(curves: Float, like: Float) -> Float:
    """Return the RMS (C,) between curves and their like."""
    return np.sqrt(np.mean((curves - like) ** 2, axis=-1))


def projection(
    curves: Float, basis: space.Space, counts: tuple[int, ...] = (3, 5, 11)
) -> dict[int, float]:
    """Return the mean RMS of the curves projected on the first components; held: 0.0057, 0.0023, 0.0005."""
    mean = {}
    for count in counts:
        part = space.truncate(basis, count)
        mean[count] = float(
            rms(curves, space.reconstruct(space.project(curves, part), part)).mean()
        )
    return mean


def without(curves: Float, k: int, near: float) -> Float:
    """Return the curves less the k-th and its copies."""
    return curves[rms(curves, curves[k]) > near]


def five_samples(
    curves: Float,
    *,
    places: Float = PLACES,
    noise: float = 0.001,
    near: float = 0.01,
    count: int = 11,
    seed: int = 0,
) -> Float:
    """Return the RMS (C,) of each curve from five samples and a prior made of the others; held: mean 0.01."""
    rng = np.random.default_rng(seed)
    own = np.linspace(0, 1, curves.shape[1])
    errors = []
    for k, curve in enumerate(curves):
        prior = space.fit_space(without(curves, k, near), count)
        values = np.interp(places, own, curve) + noise * rng.standard_normal(len(places))
        errors.append(space.fit_samples(places, values, prior))
    return rms(curves, np.array(errors))


def measured(folder: Path) -> Float:
    """Return the 201 curves (C, 1024) at even exposures."""
    exposure, brightness = measured_curves(folder)
    return np.stack(
        [
            np.interp(np.linspace(0, 1, 1024), x, m)
            for x, m in zip(exposure, brightness, strict=True)
        ]
    )


def components(folder: Path) -> Mapping[str, ArrayLike]:
    """Return what the published components leave of 201 curves, and what those computed here do."""
    curves = measured(folder)
    emor = read_emor(real(folder, "crf_curves") / "emor.txt")
    bases = {EMOR: emor, OURS: space.fit_space(curves, 11)}
    return {who: list(projection(curves, basis).values()) for who, basis in bases.items()}


def samples(folder: Path) -> Mapping[str, ArrayLike]:
    """Return how well five samples and the prior give a response."""
    errors = 100 * five_samples(measured(folder))
    return {SAMPLES: errors.mean(), "median, 95 %, worst, %": spread(errors)}


ROWS = (
    Experiment(
        "emor",
        "201 measured curves, projected on the first components",
        components,
        tuple(
            at_most(who, 0.00575, 0.00235, 0.00055) for who in (EMOR, OURS)
        ),  # 0.0057, 0.0023, 0.0005 rounded
    ),
    Experiment(
        "emor-samples",
        "five gray patches of a chart and a prior without the curve itself or its copies",
        samples,
        (at_most(SAMPLES, 1),),
    ),
)
