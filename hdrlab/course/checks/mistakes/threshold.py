"""Known mistakes in `threshold`, the task of hdrlab.align.mtb.threshold."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "threshold_always_half",
    says="You always take the median. Take the quantile q.",
)
def always_half(h, q):
    below = np.cumsum(h)
    return np.searchsorted(below, 0.5 * below[-1])


@mistake(
    "threshold_mean",
    says="This is the mean, not the median. A few bright pixels raise it, so fewer than half "
    "of the pixels are above it.",
    misses_method=True,
)
def mean(h, q):
    return int(np.sum(np.arange(256) * h) / np.sum(h))


@mistake(
    "threshold_goes_on",
    says="Where the cumulative count is exactly q, you go on to the next pixel value. At least q is "
    "enough: use side='left', or >= in place of >.",
)
def goes_on(h, q):
    below = np.cumsum(h)
    return np.searchsorted(below, np.asarray(q) * below[-1], side="right")
