"""Known mistakes in `compress`, the task of hdrlab.tonemap.durand.compress."""

import math

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "compress_dark_end_at_white",
    says="You anchor the dark end: everything is brighter than white then. The bright end is "
    "the one that becomes 1.",
)
def dark_end_at_white(base, low, high, *, contrast=50.0):
    return min(1.0, math.log10(contrast) / max(high - low, 1e-6)) * (base - low)


@mistake(
    "compress_natural_logarithm",
    says="c is a natural logarithm in your code and the base is in decades: the picture keeps "
    "2.3 times too much contrast.",
)
def natural_logarithm(base, low, high, *, contrast=50.0):
    return min(1.0, math.log(contrast) / max(high - low, 1e-6)) * (base - high)


@mistake(
    "compress_stretches",
    says="A scene of less contrast than the display has is stretched: m is at most 1.",
)
def stretches(base, low, high, *, contrast=50.0):
    return math.log10(contrast) / (high - low) * (base - high)
