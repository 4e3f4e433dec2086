"""Known mistakes in `fix_uncertain`, the task of hdrlab.tonemap.durand.fix_uncertain."""

import math

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.course.checks.mistakes import mistake
from hdrlab.tonemap.durand import UNCERTAIN_SIGMA


@mistake(
    "fix_uncertain_certainty_linear",
    says="Your certainty is proportional to k. It must grow with the logarithm of k: ln k / ln "
    "sqrt(2 pi sigma_s^2).",
)
def certainty_linear(mean, k, *, sigma_s):
    enough = (2 * math.pi * sigma_s**2) ** 0.5
    if enough <= 1 or k.min() >= enough:
        return mean
    u = np.clip(k, 1, enough) / enough
    return mean + (1 - u) * (gaussian_filter(mean, UNCERTAIN_SIGMA) - mean)


@mistake(
    "fix_uncertain_root_forgotten",
    says="You require 2 pi sigma_s^2 similar pixels for a certain base. The square root of that "
    "number is enough.",
)
def root_forgotten(mean, k, *, sigma_s):
    enough = 2 * math.pi * sigma_s**2
    if enough <= 1 or k.min() >= enough:
        return mean
    u = np.log(np.clip(k, 1, enough)) / math.log(enough)
    return mean + (1 - u) * (gaussian_filter(mean, UNCERTAIN_SIGMA) - mean)


@mistake(
    "fix_uncertain_not_clipped",
    says="Your certainty is above 1 for large k and below 0 for small k. Clip it to the range "
    "from 0 to 1.",
)
def not_clipped(mean, k, *, sigma_s):
    enough = (2 * math.pi * sigma_s**2) ** 0.5
    if enough <= 1 or k.min() >= enough:
        return mean
    u = np.log(k) / math.log(enough)
    return mean + (1 - u) * (gaussian_filter(mean, UNCERTAIN_SIGMA) - mean)
