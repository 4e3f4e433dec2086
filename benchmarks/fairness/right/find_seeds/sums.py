"""Nine of nine, counted by sums of a padded mask."""

import numpy as np


def three(a):
    p = np.pad(a, 1)
    return sum(p[i : i + a.shape[0], j : j + a.shape[1]] for i in range(3) for j in range(3))


def find_seeds(score):
    middles = (three((score > 1).astype(int)) == 9).astype(int)
    return (three(middles) > 0).astype(np.uint8)
