"""Natural logarithms over ln 2, in an array of one number."""

import numpy as np


def optimum(EV_pre, B_pre, B_opt=0.18):
    return np.array([EV_pre + np.log(B_pre / B_opt) / np.log(2)])
