"""Known mistakes in `peaks`, the task of hdrlab.align.cerman.peaks."""

import numpy as np
import scipy

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "peaks_places_instead_of_shifts",
    says="You return row and column of each peak. The middle of c is the shift (0, 0): subtract "
    "its row and column.",
)
def places_instead_of_shifts(c, count):
    is_peak = c == scipy.ndimage.maximum_filter(c, 5)
    y, x = np.nonzero(is_peak & (c > 0))
    best = np.argsort(-c[y, x], kind="stable")[:count]
    return np.stack([y[best], x[best]], axis=-1)


@mistake(
    "peaks_right_before_down",
    says="You return (dx, dy). The order is (dy, dx): rows first, as in an array.",
)
def right_before_down(c, count):
    is_peak = c == scipy.ndimage.maximum_filter(c, 5)
    y, x = np.nonzero(is_peak & (c > 0))
    best = np.argsort(-c[y, x], kind="stable")[:count]
    return np.stack([x[best] - c.shape[1] // 2, y[best] - c.shape[0] // 2], axis=-1)


@mistake(
    "peaks_largest_values",
    says="You return the largest values, which lie beside each other on one peak. Keep only "
    "those that are the largest of the 5 x 5 values around them.",
)
def largest_values(c, count):
    y, x = np.nonzero(c > 0)
    best = np.argsort(-c[y, x], kind="stable")[:count]
    return np.stack([y[best], x[best]], axis=-1) - np.array(c.shape) // 2


@mistake(
    "peaks_lowest_first",
    says="You sort the peaks from low to high, and so keep the lowest. Begin with the highest.",
)
def lowest_first(c, count):
    is_peak = c == scipy.ndimage.maximum_filter(c, 5)
    y, x = np.nonzero(is_peak & (c > 0))
    best = np.argsort(c[y, x], kind="stable")[:count]
    return np.stack([y[best], x[best]], axis=-1) - np.array(c.shape) // 2


@mistake(
    "peaks_below_0_count",
    says="You return peaks below 0, too. There the photos do not match; leave these peaks out.",
)
def below_0_count(c, count):
    y, x = np.nonzero(c == scipy.ndimage.maximum_filter(c, 5))
    best = np.argsort(-c[y, x], kind="stable")[:count]
    return np.stack([y[best], x[best]], axis=-1) - np.array(c.shape) // 2
