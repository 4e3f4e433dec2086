"""You believe the times that were given: after each fit the ratios are to be taken anew from the curve, R
= sum f(M_q) / sum f(M_q+1)."""

import numpy as np

from hdrlab.response import mitsunaga
from hdrlab.response.polynomial import curve

TASK = "recover"


def recover(images, times, *, order=5, eps=1e-3):
    parts, R = mitsunaga.averages(images, times, pixels=12_000, samples=400, valid=None)
    m = mitsunaga.moments(np.concatenate(parts, axis=1))
    g = np.stack([curve(c) for c in mitsunaga.coefficients(m, R, order)], axis=-1)
    return g.reshape(256, *np.shape(images)[3:])
