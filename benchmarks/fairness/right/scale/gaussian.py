"""scipy's Gaussian."""

from scipy.ndimage import gaussian_filter


def scale(L, *, headroom=8.0, sigma=None):
    return 1 / (headroom * gaussian_filter(L, sigma))
