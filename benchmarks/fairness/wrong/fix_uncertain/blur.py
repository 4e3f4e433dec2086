"""A blur of all."""

from scipy.ndimage import gaussian_filter


def fix_uncertain(mean, k, *, sigma_s):
    return gaussian_filter(mean, 2)
