"""Known mistakes in `find_by_locus`, the task of hdrlab.enhance.skin.find_by_locus."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.enhance.skin import LOWER, UPPER, WHITE_RADIUS_SQUARED


def chromaticities(Z):
    Z = np.asarray(Z, np.float64)
    total = np.maximum(Z.sum(axis=-1), 1)
    return Z[..., 0] / total, Z[..., 1] / total


@mistake(
    "find_by_locus_white_is_skin",
    says="You take white and gray for skin. Leave out the colors whose squared distance from "
    "r = g = 1/3 is at most 0.0004.",
)
def white_is_skin(Z):
    r, g = chromaticities(Z)
    return (np.polyval(LOWER, r) < g) & (g < np.polyval(UPPER, r)) & (r > g)


@mistake(
    "find_by_locus_green_counts",
    says="You take yellow and green colors for skin. Skin has more red than green: r > g.",
)
def green_counts(Z):
    r, g = chromaticities(Z)
    is_white = (r - 1 / 3) ** 2 + (g - 1 / 3) ** 2 <= WHITE_RADIUS_SQUARED
    return (np.polyval(LOWER, r) < g) & (g < np.polyval(UPPER, r)) & ~is_white


@mistake(
    "find_by_locus_upper_limit_alone",
    says="You test only the upper parabola. g must also be above the lower one.",
)
def upper_limit_alone(Z):
    r, g = chromaticities(Z)
    is_white = (r - 1 / 3) ** 2 + (g - 1 / 3) ** 2 <= WHITE_RADIUS_SQUARED
    return (g < np.polyval(UPPER, r)) & ~is_white & (r > g)


@mistake(
    "find_by_locus_brightness_counts",
    says="Your r and g depend on brightness, because you divide by 255. Divide by R + G + B.",
)
def brightness_counts(Z):
    r = np.asarray(Z, np.float64)[..., 0] / 255
    g = np.asarray(Z, np.float64)[..., 1] / 255
    is_white = (r - 1 / 3) ** 2 + (g - 1 / 3) ** 2 <= WHITE_RADIUS_SQUARED
    return (np.polyval(LOWER, r) < g) & (g < np.polyval(UPPER, r)) & ~is_white & (r > g)
