"""Fattal's operator with pyramids by matrix products, and equations of neighbours in bands of rows."""

from collections.abc import Iterator
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from hdrlab.core import poisson
from hdrlab.core.arrays import as_luminance
from hdrlab.core.pyramid import depth, half_shape
from hdrlab.core.steps import last
from hdrlab.core.types import F32
from hdrlab.fast import pyramid
from hdrlab.fast._bands import banded
from hdrlab.tonemap import fattal

SATURATION = fattal.SATURATION


def attenuation_steps(
    lL: F32, *, alpha: float = 0.1, beta: float = 0.9, noise: float = 0.01
) -> Iterator[fattal.Level]:
    """Yield the Level of k = d ... 0: Phi_d = phi_d, Phi_k = enlarged(Phi_(k+1)) phi_k."""
    levels = pyramid.gaussian(lL, depth(lL.shape, fattal.SMALLEST))
    Phi = np.ones(half_shape(levels[-1].shape), np.float32)
    while levels:
        k, lL = len(levels) - 1, levels.pop()
        slope = banded(partial(fattal.slope, k=k), lL, margin=1)
        phi = partial(fattal.attenuation, mean=float(slope.mean()), alpha=alpha, beta=beta, noise=noise)
        attenuation = banded(phi, slope)
        Phi = pyramid.interpolate(Phi, lL.shape)
        Phi *= attenuation
        yield fattal.Level(k, lL, slope, attenuation, Phi)


def divergence(lL: F32, Phi: F32) -> F32:
    """Return div G, for `poisson.solve`: Laplacian lLd = div G [Fattal02; Battiato08 eq. 1.40]."""
    return banded(_divergence, lL, Phi, margin=1)


def _divergence(lL: F32, Phi: F32) -> F32:
    divG = np.zeros_like(lL)
    for u, w, f in ((lL, Phi, divG), (lL.T, Phi.T, divG.T)):
        G = np.diff(u, axis=0) * ((w[1:] + w[:-1]) * np.float32(0.5))
        f[:-1] += G
        f[1:] -= G
    return divG


def tonemap(
    L: ArrayLike,
    *,
    alpha: float = 0.1,
    beta: float = 0.9,
    noise: float = 0.01,
    black: float = 0.001,
    white: float = 0.005,
) -> F32:
    """Return display luminance in which steep slopes of ln L are flattened, and gentle ones kept."""
    knobs = {"alpha": alpha, "beta": beta, "noise": noise}
    fattal.tonemap(np.zeros((1, 1)), **knobs, black=black, white=white)  # refuses knobs out of their range
    L = as_luminance(L)
    if L.max() == 0:
        return np.zeros_like(L)
    lL = fattal.log_luminance(L)
    lLd = poisson.solve(divergence(lL, last(attenuation_steps(lL, **knobs)).Phi))
    return fattal.display(lLd, black=black, white=white)
