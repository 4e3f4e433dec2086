"""Too bright asks for a smaller EV."""

import numpy as np


def optimum(EV_pre, B_pre, B_opt=0.18):
    return EV_pre + np.log2(B_opt) - np.log2(B_pre)
