"""A median takes specks away."""

from scipy.ndimage import median_filter


def find_seeds(score):
    return median_filter(score, 3) > 1
