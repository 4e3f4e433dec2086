"""A Gaussian blur of p, whatever the guide."""

from scipy.ndimage import gaussian_filter


def guided(I, p=None, *, radius, epsilon):
    return gaussian_filter(I if p is None else p, radius)
