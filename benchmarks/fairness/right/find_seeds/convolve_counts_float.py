import numpy as np
from scipy.signal import convolve2d


def find_seeds(score):
    over = np.where(np.asarray(score) > 1, 1, 0)
    nine = convolve2d(over, np.ones((3, 3), int), mode="same", boundary="fill", fillvalue=0)
    seeds = (nine == 9).astype(int)
    hit = convolve2d(seeds, np.ones((3, 3), int), mode="same", boundary="fill", fillvalue=0)
    return (hit > 0).astype(np.float64)
