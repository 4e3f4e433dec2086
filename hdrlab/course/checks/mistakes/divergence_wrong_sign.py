"""Your divergence has the opposite sign: it is what flows out of a pixel, G(x) - G(x - 1)."""

from hdrlab.core.filters import poisson


def divergence(G):
    return -poisson.divergence(G)
