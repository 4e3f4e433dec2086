"""Known mistakes in `weight`, the task of hdrlab.enhance.mertens.weight."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.enhance.mertens import LUMA, SIGMA, SMALLEST_WEIGHT, contrast, exposedness, saturation


@mistake(
    "weight_sign_kept",
    says="A Laplacian is negative at bright spots, but a weight must not be negative: take its "
    "absolute value.",
)
def sign_kept(F, powers=(1, 1, 1)):
    def contrast(F):
        Y = F[0] if len(F) == 1 else LUMA[0] * F[0] + LUMA[1] * F[1] + LUMA[2] * F[2]
        Y = np.pad(Y, 1, mode="reflect")
        rows = Y[:-2, 1:-1] + Y[2:, 1:-1]
        columns = Y[1:-1, :-2] + Y[1:-1, 2:]
        # summed by pairs: 2 Y + 2 Y is 4 Y without rounding, where Y is flat
        return rows + columns - 4 * Y[1:-1, 1:-1]

    W = np.ones(F.shape[1:], np.float32)
    for measure, power in zip((contrast, saturation, exposedness), powers, strict=True):
        if power:
            W *= measure(F) if power == 1 else measure(F) ** np.float32(power)
    return W + np.float32(SMALLEST_WEIGHT)


@mistake(
    "weight_measures_added",
    says="You add the three measures, so a clipped pixel with fine texture has a weight. Multiply"
    " them: a product is small if one factor is small.",
)
def measures_added(F, powers=(1, 1, 1)):
    W = np.zeros(F.shape[1:], np.float32)
    for measure, power in zip((contrast, saturation, exposedness), powers, strict=True):
        if power:
            W += measure(F) if power == 1 else measure(F) ** np.float32(power)
    return W + np.float32(SMALLEST_WEIGHT)


@mistake(
    "weight_exposedness_of_the_mean",
    says="You measure how well the mean of the channels is exposed. Multiply over the "
    "channels, so that one badly exposed channel lowers the weight.",
)
def exposedness_of_the_mean(F, powers=(1, 1, 1)):
    def exposedness(F):
        return np.exp((sum(F) / 3 - np.float32(0.5)) ** 2 * np.float32(-0.5 / SIGMA**2))

    W = np.ones(F.shape[1:], np.float32)
    for measure, power in zip((contrast, saturation, exposedness), powers, strict=True):
        if power:
            W *= measure(F) if power == 1 else measure(F) ** np.float32(power)
    return W + np.float32(SMALLEST_WEIGHT)
