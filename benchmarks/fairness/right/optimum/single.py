"""float32."""

import numpy as np


def optimum(EV_pre, B_pre, B_opt=0.18):
    f = np.float32
    return f(EV_pre) + np.log2(f(B_pre)) - np.log2(f(B_opt))
