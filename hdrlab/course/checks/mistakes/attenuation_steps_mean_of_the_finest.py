"""alpha is a tenth of the mean slope at each level; you took the mean of the finest level for all."""

import numpy as np

from hdrlab.core.filters import pyramid
from hdrlab.tonemap import fattal


def attenuation_steps(lL, *, alpha=0.1, beta=0.9, noise=0.01):
    levels = pyramid.gaussian(lL, pyramid.depth(lL.shape, 32))
    slopes = [fattal.slope(one, k) for k, one in enumerate(levels)]
    mean = 4 * float(slopes[0].mean())
    Phi = np.ones(pyramid.half_shape(levels[-1].shape), np.float32)
    for k in reversed(range(len(levels))):
        phi = fattal.attenuation(slopes[k], mean, alpha=alpha, beta=beta, noise=noise)
        Phi = pyramid.interpolate(Phi, levels[k].shape) * phi
        yield k, levels[k], slopes[k], phi, Phi
