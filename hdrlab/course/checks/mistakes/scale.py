"""Known mistakes in `scale`, the task of hdrlab.tonemap.chiu.scale."""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.course.checks.mistakes import mistake
from hdrlab.tonemap.chiu import SMALLEST_DIVISOR, choose_sigma


@mistake(
    "scale_blur_of_the_inverse",
    says="You blurred 1 / L, a mean in which dark pixels count most. Blur L first, and then "
    "divide.",
)
def blur_of_the_inverse(L, *, headroom=8.0, sigma=None):
    return gaussian_filter(1 / L, choose_sigma(L, sigma)) / headroom


@mistake(
    "scale_headroom_above",
    says="k belongs in the denominator. More headroom makes the image darker, so that bright "
    "pixels are not clipped.",
)
def headroom_above(L, *, headroom=8.0, sigma=None):
    return headroom / np.maximum(gaussian_filter(L, choose_sigma(L, sigma)), SMALLEST_DIVISOR)


@mistake(
    "scale_times_luminance",
    says="You return s L. s = 1 / (k blur(L)) is only the scale. One lecture prints a further "
    "factor L, which is a misprint.",
)
def times_luminance(L, *, headroom=8.0, sigma=None):
    return L / np.maximum(headroom * gaussian_filter(L, choose_sigma(L, sigma)), SMALLEST_DIVISOR)


@mistake(
    "scale_not_blurred",
    says="You divided by L itself, so every pixel becomes 1 / k. The scale depends on the "
    "blurred luminance around the pixel.",
    misses_method=True,
)
def not_blurred(L, *, headroom=8.0, sigma=None):
    return 1 / np.maximum(headroom * L, SMALLEST_DIVISOR)


@mistake(
    "scale_headroom_above_times_luminance",
    says="You return k L / blur(L). The scale has neither k nor L in its numerator: s = 1 / (k "
    "blur(L)).",
    misses_method=True,
)
def headroom_above_times_luminance(L, *, headroom=8.0, sigma=None):
    return headroom * L / np.maximum(gaussian_filter(L, choose_sigma(L, sigma)), SMALLEST_DIVISOR)
