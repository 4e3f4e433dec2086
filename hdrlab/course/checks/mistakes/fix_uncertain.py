"""Known mistakes in `fix_uncertain`, the task of hdrlab.tonemap.durand.fix_uncertain."""

import math

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.course.checks.mistakes import mistake
from hdrlab.tonemap.durand import NEAR


@mistake(
    "fix_uncertain_certainty_linear",
    says="Your certainty rises with k itself: it rises with its logarithm, ln k / ln of the "
    "root of 2 pi sigma_s^2.",
)
def certainty_linear(mean, k, *, sigma_s):
    enough = (2 * math.pi * sigma_s**2) ** 0.5
    if enough <= 1 or k.min() >= enough:
        return mean
    u = np.clip(k, 1, enough) / enough
    return mean + (1 - u) * (gaussian_filter(mean, NEAR) - mean)


@mistake(
    "fix_uncertain_root_forgotten",
    says="You ask for all 2 pi sigma_s^2 pixels before a base is certain: the root of that is "
    "enough.",
)
def root_forgotten(mean, k, *, sigma_s):
    enough = 2 * math.pi * sigma_s**2
    if enough <= 1 or k.min() >= enough:
        return mean
    u = np.log(np.clip(k, 1, enough)) / math.log(enough)
    return mean + (1 - u) * (gaussian_filter(mean, NEAR) - mean)


@mistake(
    "fix_uncertain_not_clipped",
    says="Your certainty is above 1 where k is large, and below 0 where it is small: keep it "
    "between 0 and 1.",
)
def not_clipped(mean, k, *, sigma_s):
    enough = (2 * math.pi * sigma_s**2) ** 0.5
    if enough <= 1 or k.min() >= enough:
        return mean
    u = np.log(k) / math.log(enough)
    return mean + (1 - u) * (gaussian_filter(mean, NEAR) - mean)
