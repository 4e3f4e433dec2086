"""scipy's Hermite spline with flat ends."""

import numpy as np
from scipy.interpolate import CubicHermiteSpline


def consistency(v, v_):
    curve = CubicHermiteSpline([0, 16 / 255], [1, 0], [0, 0])
    d = np.maximum((v - v_).max(-1), (v_ - v).max(-1))
    return np.expand_dims(curve(np.minimum(d, 16 / 255)), -1)
