"""Your phi comes from the wrong level: Phi_k takes the phi of level k itself, and you took that of the next
coarser one again."""

import numpy as np

from hdrlab.core.filters import pyramid
from hdrlab.tonemap import fattal


def attenuation_steps(lL, *, alpha=0.1, beta=0.9, noise=0.01):
    levels = pyramid.gaussian(lL, pyramid.depth(lL.shape, 32))
    slopes = [fattal.slope(one, k) for k, one in enumerate(levels)]
    Phi = np.ones(pyramid.half_shape(levels[-1].shape), np.float32)
    for k in reversed(range(len(levels))):
        j = min(k + 1, len(levels) - 1)
        phi = fattal.attenuation(slopes[j], float(slopes[j].mean()), alpha=alpha, beta=beta, noise=noise)
        if j > k:
            phi = pyramid.interpolate(phi, levels[k].shape)
        Phi = pyramid.interpolate(Phi, levels[k].shape) * phi
        yield k, levels[k], slopes[k], phi, Phi
