"""Known mistakes in `find_seeds`, the task of hdrlab.radiance.deghosting.regions.find_seeds."""

import numpy as np
from scipy import ndimage

from hdrlab.course.checks.mistakes import mistake
from hdrlab.radiance.deghosting.regions import SEED_SIDE


@mistake(
    "find_seeds_threshold_alone",
    says="You mark all that is above 1, specks and lines too: mark only what lies in a square "
    "of 3 x 3 that is above 1 throughout.",
    misses_method=True,
)
def threshold_alone(score):
    return score > 1


@mistake(
    "find_seeds_middles_alone",
    says="You mark the middle of each square alone, so a figure loses its rim: mark all nine "
    "pixels of it.",
)
def middles_alone(score):
    return ndimage.binary_erosion(score > 1, np.ones((SEED_SIDE, SEED_SIDE), bool))


@mistake(
    "find_seeds_cross",
    says="You ask for a cross of five pixels, which a corner of 3 x 3 need not fill: ask for "
    "all nine of the square.",
)
def cross(score):
    return ndimage.binary_opening(score > 1)
