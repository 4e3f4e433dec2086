"""Gaussian blur of 1 pixel, scipy throughout; enlarged by map_coordinates at half the indices; flat is 1."""

import numpy as np
from scipy import ndimage


def attenuation_steps(lL, *, alpha=0.1, beta=0.9, noise=0.01):
    pyramid = [np.asarray(lL, dtype=np.float64)]
    while min((n + 1) // 2 for n in pyramid[-1].shape) >= 32:
        pyramid.append(ndimage.gaussian_filter(pyramid[-1], 1.0, mode="mirror")[::2, ::2])
    Phi = None
    for k in range(len(pyramid) - 1, -1, -1):
        l = pyramid[k]
        gy = ndimage.correlate1d(l, [-1, 0, 1], axis=0, mode="mirror") / 2 ** (k + 1)
        gx = ndimage.correlate1d(l, [-1, 0, 1], axis=1, mode="mirror") / 2 ** (k + 1)
        slope = np.sqrt(gy**2 + gx**2)
        mean = slope.mean()
        if mean > 0:
            phi = (np.maximum(slope, noise * mean) / (alpha * mean)) ** (beta - 1)
        else:
            phi = np.ones_like(l)
        if Phi is None:
            Phi = phi
        else:
            places = np.indices(l.shape) / 2
            Phi = ndimage.map_coordinates(Phi, places, order=1, mode="nearest") * phi
        yield k, l, slope, phi, Phi
