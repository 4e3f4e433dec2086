"""Known mistakes in `find_seeds`, the task of hdrlab.radiance.deghosting.regions.find_seeds."""

import numpy as np
from scipy import ndimage

from hdrlab.course.checks.mistakes import mistake
from hdrlab.radiance.deghosting.regions import SEED_SIDE


@mistake(
    "find_seeds_threshold_alone",
    says="You mark everything above 1, including specks and lines. Mark only pixels in a 3 x 3 "
    "square that is above 1 everywhere.",
    misses_method=True,
)
def threshold_alone(score):
    return score > 1


@mistake(
    "find_seeds_middles_alone",
    says="You mark only the middle pixel of each square, so an object loses its rim. Mark all "
    "nine pixels of the square.",
)
def middles_alone(score):
    return ndimage.binary_erosion(score > 1, np.ones((SEED_SIDE, SEED_SIDE), bool))


@mistake(
    "find_seeds_cross",
    says="You look for a cross of five pixels, without the corners of the 3 x 3 square. All "
    "nine pixels must be above 1.",
)
def cross(score):
    return ndimage.binary_opening(score > 1)
