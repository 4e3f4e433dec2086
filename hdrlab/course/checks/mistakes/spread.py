"""Known mistakes in `spread`, the task of hdrlab.tonemap.curves.spread."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.tonemap import curves


@mistake(
    "spread_sorted_apart",
    says="You sort Ld by itself, so any operator looks like a curve. Sort the pixels by L, and take "
    "Ld in the same order.",
)
def sorted_apart(L, Ld, *, bins=64):
    return curves.spread(np.sort(L, axis=None), np.sort(Ld, axis=None), bins=bins)


@mistake(
    "spread_classes_of_display",
    says="Your classes contain pixels of equal Ld. They must contain pixels of equal L.",
)
def classes_of_display(L, Ld, *, bins=64):
    order = np.argsort(Ld, axis=None)
    classes = np.array_split(order, bins)
    luminance = np.array([np.median(L.flat[pixels]) for pixels in classes])
    lowest = np.array([Ld.flat[pixels].min() for pixels in classes])
    highest = np.array([Ld.flat[pixels].max() for pixels in classes])
    return luminance, lowest, highest


@mistake(
    "spread_equal_widths",
    says="Your classes have the same width in ln L, so some have few pixels. They must have the "
    "same number of pixels.",
)
def equal_widths(L, Ld, *, bins=64):
    b = np.log(L)
    edges = np.linspace(b.min(), b.max(), bins + 1)
    number = np.clip(np.searchsorted(edges, b, side="right") - 1, 0, bins - 1)
    luminance = np.exp((edges[1:] + edges[:-1]) / 2)
    lowest = np.array([Ld[number == k].min(initial=1) for k in range(bins)])
    highest = np.array([Ld[number == k].max(initial=0) for k in range(bins)])
    return luminance, lowest, highest


@mistake(
    "spread_brightest_first",
    says="Your classes begin with the brightest. Begin with the darkest.",
)
def brightest_first(L, Ld, *, bins=64):
    luminance, lowest, highest = curves.spread(L, Ld, bins=bins)
    return luminance[::-1], lowest[::-1], highest[::-1]


@mistake(
    "spread_standard_deviation",
    says="You return the mean minus and plus a standard deviation. Return the minimum and the "
    "maximum.",
)
def standard_deviation(L, Ld, *, bins=64):
    order = np.argsort(L, axis=None)
    classes = np.array_split(order, bins)
    mean = np.array([Ld.flat[pixels].mean() for pixels in classes])
    deviation = np.array([Ld.flat[pixels].std() for pixels in classes])
    return curves.spread(L, Ld, bins=bins)[0], mean - deviation, mean + deviation
