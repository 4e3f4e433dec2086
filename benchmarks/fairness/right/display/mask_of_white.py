"""First the mask of what becomes white, by comparing numerator and denominator; division only elsewhere."""

import numpy as np


def display(Lm, adaptation, white=np.inf):
    Lm, V = np.broadcast_arrays(np.asarray(Lm, float), np.asarray(adaptation, float))
    above = Lm * (1 + Lm * white**-2.0)
    below = 1 + V
    Ld = np.ones(Lm.shape)
    np.divide(above, below, out=Ld, where=above < below)
    return Ld
