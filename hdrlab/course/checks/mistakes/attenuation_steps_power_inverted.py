"""Your phi grows with the slope: steep slopes are made steeper. The power is beta - 1, which is negative."""

import numpy as np

from hdrlab.core.filters import pyramid
from hdrlab.tonemap import fattal


def attenuation_steps(lL, *, alpha=0.1, beta=0.9, noise=0.01):
    levels = pyramid.gaussian(lL, pyramid.depth(lL.shape, 32))
    slopes = [fattal.slope(one, k) for k, one in enumerate(levels)]
    Phi = np.ones(pyramid.half_shape(levels[-1].shape), np.float32)
    for k in reversed(range(len(levels))):
        mean = float(slopes[k].mean())
        phi = 1 / fattal.attenuation(slopes[k], mean, alpha=alpha, beta=beta, noise=noise)
        Phi = pyramid.interpolate(Phi, levels[k].shape) * phi
        yield k, levels[k], slopes[k], phi, Phi
