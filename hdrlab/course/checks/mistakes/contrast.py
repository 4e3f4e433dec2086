"""Known mistakes in `contrast`, the task of hdrlab.enhance.battiato.contrast."""

import numpy as np
from scipy.ndimage import correlate1d

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "contrast_not_smoothed",
    says="You use the histogram itself. First replace each entry by the mean of the five around it.",
)
def not_smoothed(block):
    i = np.asarray(block, np.float64)
    return float(np.abs(i - i.mean()).mean())


@mistake(
    "contrast_standard_deviation",
    says="You compute the standard deviation. D is the mean of |i - M|, without squares.",
)
def standard_deviation(block):
    i = np.arange(256)
    counts = np.bincount(np.rint(block).astype(int).ravel(), minlength=256).astype(float)
    smoothed = correlate1d(counts, np.full(5, 0.2), mode="constant")
    M = np.average(i, weights=smoothed)
    return float(np.sqrt(np.average((i - M) ** 2, weights=smoothed)))


@mistake(
    "contrast_distance_from_the_middle",
    says="You measure the distance from the middle of the range. Take the mean M of the block itself.",
)
def distance_from_the_middle(block):
    i = np.arange(256)
    counts = np.bincount(np.rint(block).astype(int).ravel(), minlength=256).astype(float)
    smoothed = correlate1d(counts, np.full(5, 0.2), mode="constant")
    return float(np.average(np.abs(i - 127.5), weights=smoothed))


@mistake(
    "contrast_ends_repeated",
    says="You repeat the ends of the histogram beyond 0 and 255. There it is 0.",
)
def ends_repeated(block):
    i = np.arange(256)
    counts = np.bincount(np.rint(block).astype(int).ravel(), minlength=256).astype(float)
    smoothed = correlate1d(counts, np.full(5, 0.2), mode="nearest")
    M = np.average(i, weights=smoothed)
    return float(np.average(np.abs(i - M), weights=smoothed))
