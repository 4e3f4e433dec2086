"""Binary dilation by a disc; holes are the parts of the rest that touch no edge; 0 and 1."""

import numpy as np
from scipy import ndimage


def dilate(mask, margin):
    r = np.arange(-margin, margin + 1)
    wide = ndimage.binary_dilation(
        np.asarray(mask, bool), structure=r[:, None] ** 2 + r**2 <= margin**2
    )
    parts, _ = ndimage.label(~wide)
    outer = np.unique(np.concatenate([parts[0], parts[-1], parts[:, 0], parts[:, -1]]))
    outer = outer[outer > 0]
    return (~np.isin(parts, outer)).astype(np.uint8)
