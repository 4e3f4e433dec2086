"""Your curve takes L for a number without a unit: the same scene in other units gives another picture.
Scale it by its log average first."""

import numpy as np


def tonemap(L, **knobs):
    L = np.asarray(L, float)
    return L / (1 + L)
