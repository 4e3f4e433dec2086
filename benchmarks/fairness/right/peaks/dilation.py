"""Gray dilation, whose border repeats the image mirrored; int16 answers."""

import numpy as np
from scipy.ndimage import grey_dilation


def peaks(c, count):
    mask = (grey_dilation(c, size=(5, 5)) == c) * (c > 0)
    y, x = mask.nonzero()
    keep = np.lexsort((x, y, -c[y, x]))[:count]
    shifts = np.array([y[keep], x[keep]]).T - (np.array(c.shape) - 1) // 2
    return shifts.astype(np.int16)
