"""How near the gray of each pixel is to the middle."""

import numpy as np


def weight(F, powers=(1, 1, 1)):
    return 1 - 2 * np.abs(F.mean(axis=0) - 0.5)
