"""Natural logarithms."""

import numpy as np


def optimum(EV_pre, B_pre, B_opt=0.18):
    return EV_pre + np.log(B_pre) - np.log(B_opt)
