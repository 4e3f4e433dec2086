"""Your base is a plain blur: it crosses the edges, and leaves halos. Weight each neighbour by its
difference in lL too."""

from scipy.ndimage import gaussian_filter


def layers(lL, *, sigma_s, sigma_r=0.4):
    base = gaussian_filter(lL, sigma_s)
    return base, lL - base
