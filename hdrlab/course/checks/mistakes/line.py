"""Known mistakes in `line`, the task of hdrlab.capture.photon_transfer.line."""

import numpy as np

from hdrlab.capture.photon_transfer import ROUNDING_VARIANCE
from hdrlab.course.checks.mistakes import mistake


@mistake(
    "line_not_weighted",
    says="You give all pairs the same weight. The variance of a bright pair has the largest "
    "error, so it needs the smallest weight, 1 / V^2.",
    misses_method=True,
)
def not_weighted(S, V):
    w = np.ones(len(V))
    return float((w * S * (V - V[0])).sum() / (w * S**2).sum())


@mistake(
    "line_dark_pair_left_in",
    says="Your V still contains the read noise. Subtract the variance of the dark pair, V[0], "
    "from all of them.",
)
def dark_pair_left_in(S, V):
    w = 1 / np.maximum(V, ROUNDING_VARIANCE) ** 2
    return float((w * S * V).sum() / (w * S**2).sum())


@mistake(
    "line_weighted_by_the_deviation",
    says="The error of a variance is proportional to the variance, so its weight is 1 / V^2. "
    "You used 1 / V.",
)
def weighted_by_the_deviation(S, V):
    w = 1 / np.maximum(V, ROUNDING_VARIANCE)
    return float((w * S * (V - V[0])).sum() / (w * S**2).sum())


@mistake(
    "line_turned_over",
    says="You return K, electrons per pixel value. The slope of the line is 1 / K.",
)
def turned_over(S, V):
    w = 1 / np.maximum(V, ROUNDING_VARIANCE) ** 2
    return float((w * S**2).sum() / (w * S * (V - V[0])).sum())
