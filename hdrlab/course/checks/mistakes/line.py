"""Known mistakes in `line`, the task of hdrlab.capture.photon_transfer.line."""

import numpy as np

from hdrlab.capture.photon_transfer import ROUNDING_VARIANCE
from hdrlab.course.checks.mistakes import mistake


@mistake(
    "line_not_weighted",
    says="All pairs count alike in your line: the variance of a bright pair errs by most, so "
    "it counts least, by 1 / V^2.",
    misses_method=True,
)
def not_weighted(S, V):
    w = np.ones(len(V))
    return float((w * S * (V - V[0])).sum() / (w * S**2).sum())


@mistake(
    "line_dark_pair_left_in",
    says="The read noise is still in your V: take the variance of the dark pair, V[0], off all "
    "of them.",
)
def dark_pair_left_in(S, V):
    w = 1 / np.maximum(V, ROUNDING_VARIANCE) ** 2
    return float((w * S * V).sum() / (w * S**2).sum())


@mistake(
    "line_weighted_by_the_deviation",
    says="A variance errs in proportion to itself, so its weight is 1 / V^2; you took 1 / V.",
)
def weighted_by_the_deviation(S, V):
    w = 1 / np.maximum(V, ROUNDING_VARIANCE)
    return float((w * S * (V - V[0])).sum() / (w * S**2).sum())


@mistake(
    "line_turned_over",
    says="You answer K, electrons a level; asked is the slope of the line, which is 1 / K.",
)
def turned_over(S, V):
    w = 1 / np.maximum(V, ROUNDING_VARIANCE) ** 2
    return float((w * S**2).sum() / (w * S * (V - V[0])).sum())
