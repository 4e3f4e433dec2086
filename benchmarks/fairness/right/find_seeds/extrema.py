"""The maximum of minima, with nothing past the edge."""

from scipy.ndimage import maximum_filter, minimum_filter


def find_seeds(score):
    inner = minimum_filter(score, 3, mode="constant", cval=0)
    return maximum_filter(inner, 3, mode="constant", cval=0) > 1
