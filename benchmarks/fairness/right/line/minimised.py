"""The sum of squares is minimised over the slope."""

import numpy as np
from scipy.optimize import minimize_scalar


def line(S, V):
    def cost(slope):
        return np.sum(((V - V[0] - slope * S) / V) ** 2)

    top = 2 * np.max((V - V[0]) / np.maximum(S, 1e-9))
    return minimize_scalar(cost, bounds=(0, top), method="bounded", options={"xatol": 1e-7 * top}).x
