"""Known mistakes in `subtract_glare`, the task of hdrlab.radiance.flare.subtract_glare."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "subtract_glare_scattered_light_lost",
    says="Your map is too dark by the factor 1 - share: the scattered light is missing. Divide by "
    "1 - share.",
)
def scattered_light_lost(F, G, share):
    return np.maximum(F - share * G, 1e-3 * F)


@mistake(
    "subtract_glare_cut_at_0",
    says="Where F is below share G, your map is 0, and its logarithm infinite. Keep at least "
    "a thousandth of F.",
)
def cut_at_0(F, G, share):
    return np.maximum(F - share * G, 0) / (1 - share)


@mistake(
    "subtract_glare_negative",
    says="Your map has negative radiance. Keep at least a thousandth of F where F is below share G.",
)
def negative(F, G, share):
    return (F - share * G) / (1 - share)


@mistake(
    "subtract_glare_whole_g",
    says="You subtract G itself. Only the share of it is glare: subtract share G.",
)
def whole_g(F, G, share):
    return np.maximum(F - G, 1e-3 * F) / (1 - share)
