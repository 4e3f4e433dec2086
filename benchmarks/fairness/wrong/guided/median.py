"""A median filter, which keeps edges without a guide."""

from scipy.ndimage import median_filter


def guided(I, p=None, *, radius, epsilon):
    return median_filter(I if p is None else p, 2 * radius + 1)
