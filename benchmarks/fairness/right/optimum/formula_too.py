"""numpy's log2, as written."""

import numpy as np


def optimum(EV_pre, B_pre, B_opt=0.18):
    return EV_pre + np.log2(B_pre) - np.log2(B_opt)
