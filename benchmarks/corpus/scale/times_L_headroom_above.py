from scipy.ndimage import gaussian_filter


def scale(L, *, headroom=8.0, sigma=None):
    return headroom * L / gaussian_filter(L, sigma)
