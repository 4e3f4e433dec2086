"""Flat-field correction: remove the vignetting of the lens and the differences between pixels.

Z     pixel values of a photo                                     (H, W), linear in the light
flat  pixel values of a photo of a white wall by the same camera  (H, W), above 0
"""

import numpy as np


def TASK(Z, flat):
    """Return Z mean(flat) / flat: the pixel values as if every pixel got the same fraction of the light.

    Parameters
    ----------
    Z : (H, W) pixel values
    flat : (H, W) pixel values of a white wall, above 0

    Returns
    -------
    corrected : (H, W) float
    """
    flat = np.asarray(flat, float)
    return Z * (flat.mean() / flat)
