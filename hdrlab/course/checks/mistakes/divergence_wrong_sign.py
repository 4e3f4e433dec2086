"""A wrong divergence: wrong sign."""

from hdrlab.core import poisson

TASK = "divergence"
MISCONCEPTION = "Your divergence has the opposite sign: it is what flows out of a pixel, G(x) - G(x - 1)."


def divergence(G):
    return -poisson.divergence(G)
