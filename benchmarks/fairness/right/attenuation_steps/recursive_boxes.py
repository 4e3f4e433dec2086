"""Recursion from the picture down; a blur of 3 by 3 equal weights; enlarged by RegularGridInterpolator."""

import numpy as np
from scipy.interpolate import RegularGridInterpolator
from scipy.ndimage import uniform_filter


def slopes(l, k):
    p = np.pad(l, 1, mode="edge")
    dy = (p[2:] - p[:-2])[:, 1:-1]
    dx = (p[:, 2:] - p[:, :-2])[1:-1]
    return np.linalg.norm(np.stack([dy, dx]), axis=0) / 2 ** (k + 1)


def enlarged(small, shape):
    grid = [np.arange(n) * 2.0 for n in small.shape]
    places = np.meshgrid(
        *(np.minimum(np.arange(n), g[-1]) for n, g in zip(shape, grid)), indexing="ij"
    )
    return RegularGridInterpolator(grid, small, method="linear")(np.stack(places, axis=-1))


def descend(l, k, attenuate):
    slope = slopes(l, k)
    phi = attenuate(slope)
    coarser = None
    if all((n + 1) // 2 >= 32 for n in l.shape):
        for step in descend(uniform_filter(l, 3, mode="reflect")[::2, ::2], k + 1, attenuate):
            yield step
            coarser = step[-1]
    Phi = phi if coarser is None else enlarged(coarser, l.shape) * phi
    yield k, l, slope, phi, Phi


def attenuation_steps(lL, *, alpha=0.1, beta=0.9, noise=0.01):
    def attenuate(slope):
        mean = slope.mean()
        if not mean > 0:
            return np.ones_like(slope)
        return (np.maximum(slope / mean, noise) / alpha) ** (beta - 1)

    yield from descend(np.asarray(lL, dtype=float), 0, attenuate)
