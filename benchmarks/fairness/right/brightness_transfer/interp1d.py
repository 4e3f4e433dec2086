"""scipy's interp1d, with NaN beyond what B's inner levels span."""

import numpy as np
from scipy.interpolate import interp1d


def brightness_transfer(h_A, h_B):
    h_A, h_B = np.asarray(h_A, float), np.asarray(h_B, float)
    H_A = np.append(0, np.cumsum(h_A)) / h_A.sum()
    H_B = np.append(0, np.cumsum(h_B)) / h_B.sum()
    inner = interp1d(H_B[1:-1], np.arange(1, len(h_B)) - 0.5, bounds_error=False, fill_value=np.nan)
    return inner((H_A[:-1] + H_A[1:]) / 2)
