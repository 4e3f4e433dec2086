"""In float32."""

import numpy as np


def optimum(EV_pre, B_pre, B_opt=0.18):
    return np.float32(EV_pre) + np.log2(np.float32(B_pre) / np.float32(B_opt))
