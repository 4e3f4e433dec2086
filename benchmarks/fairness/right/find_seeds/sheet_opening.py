import numpy as np
from scipy import ndimage


def find_seeds(score):
    return ndimage.binary_opening(np.asarray(score) > 1, structure=np.ones((3, 3), bool))
