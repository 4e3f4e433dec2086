"""Changes only the pixels that are uncertain, in place of a copy, in float32."""

import numpy as np
from scipy.ndimage import gaussian_filter1d


def fix_uncertain(mean, k, *, sigma_s):
    base = np.array(mean, np.float32)
    smooth = gaussian_filter1d(gaussian_filter1d(base, 2, axis=0), 2, axis=1, mode="mirror")
    u = np.log(np.maximum(k, 1)) / np.log(np.float32(np.sqrt(2 * np.pi) * sigma_s))
    uncertain = u < 1
    base[uncertain] = (u * base + (1 - u) * smooth)[uncertain]
    return base
