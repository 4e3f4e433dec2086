"""Known mistakes in `compress`, the task of hdrlab.tonemap.durand.compress."""

import math

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "compress_dark_end_at_white",
    says="You map the dark end to white, so everything else is brighter than white. Map the "
    "bright end to white.",
)
def dark_end_at_white(base, low, high, *, contrast=50.0):
    return min(1.0, math.log10(contrast) / max(high - low, 1e-6)) * (base - low)


@mistake(
    "compress_natural_logarithm",
    says="Your c is a natural logarithm, but the base is in decades. The image keeps 2.3 times "
    "too much contrast. Use log10.",
)
def natural_logarithm(base, low, high, *, contrast=50.0):
    return min(1.0, math.log(contrast) / max(high - low, 1e-6)) * (base - high)


@mistake(
    "compress_stretches",
    says="You stretch a scene that has less contrast than the display. Limit m to at most 1.",
)
def stretches(base, low, high, *, contrast=50.0):
    return math.log10(contrast) / (high - low) * (base - high)


@mistake(
    "compress_not_moved_to_white",
    says="You compress the base, but you do not move it. Subtract `high` from the base, so that the "
    "bright end becomes white.",
)
def not_moved_to_white(base, low, high, *, contrast=50.0):
    return min(1.0, math.log10(contrast) / max(high - low, 1e-6)) * base


@mistake(
    "compress_natural_logarithm_stretches",
    says="Your c is a natural logarithm, but the base is in decades: use log10. And m must be at "
    "most 1, so that no scene is stretched.",
)
def natural_logarithm_stretches(base, low, high, *, contrast=50.0):
    return math.log(contrast) / (high - low) * (base - high)
