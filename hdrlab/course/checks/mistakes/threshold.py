"""Known mistakes in `threshold`, the task of hdrlab.align.mtb.threshold."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "threshold_always_half",
    says="You always take the median; q says which percentile is asked for.",
)
def always_half(h, q):
    below = np.cumsum(h)
    return np.searchsorted(below, 0.5 * below[-1])


@mistake(
    "threshold_mean",
    says="This is the mean, not the median: a few bright pixels pull it up, and no longer are "
    "half of the pixels above it.",
    misses_method=True,
)
def mean(h, q):
    return int(np.sum(np.arange(256) * h) / np.sum(h))
