"""You attenuate by the finest level alone: a soft edge of a large contrast has gentle slopes there, and
comes through."""

from hdrlab.core.filters import pyramid
from hdrlab.tonemap import fattal


def attenuation_steps(lL, *, alpha=0.1, beta=0.9, noise=0.01):
    levels = pyramid.gaussian(lL, pyramid.depth(lL.shape, 32))
    slopes = [fattal.slope(one, k) for k, one in enumerate(levels)]
    for k in reversed(range(len(levels))):
        phi = fattal.attenuation(slopes[k], float(slopes[k].mean()), alpha=alpha, beta=beta, noise=noise)
        yield k, levels[k], slopes[k], phi, phi
