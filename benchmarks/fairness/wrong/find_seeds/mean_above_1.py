"""The mean of a square above 1."""

from scipy.ndimage import uniform_filter


def find_seeds(score):
    return uniform_filter(score.astype(float), 3) > 1
