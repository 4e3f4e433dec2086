"""All light as one number, 2 to the power of EV, and its logarithm at the end; a 0-d array."""

import numpy as np


def optimum(EV_pre, B_pre, B_opt=0.18):
    return np.asarray(np.log2(np.exp2(float(EV_pre)) * B_pre / B_opt))
