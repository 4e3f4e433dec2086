import numpy as np
from scipy.ndimage import maximum_filter, minimum_filter


def find_seeds(score):
    above = (np.asarray(score) > 1).astype(np.uint8)
    middle = minimum_filter(above, size=3, mode="constant", cval=0)
    return maximum_filter(middle, size=3, mode="constant", cval=0)
