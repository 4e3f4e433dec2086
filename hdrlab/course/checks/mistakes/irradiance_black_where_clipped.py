"""Where no frame saw the sample well nothing is known of it. You answer 0, which is the darkest there is:
a dark sun."""

import numpy as np


def irradiance(Z, t, f_inv, w):
    below = w[Z] @ t**2
    return np.where(below > 0, (w[Z] * f_inv[Z]) @ t / np.where(below > 0, below, 1), 0.0)
