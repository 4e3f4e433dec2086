"""Known mistakes in `lowest_ratio`, the task of hdrlab.radiance.flare.lowest_ratio."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.radiance.flare import HIGH_QUANTILE, LOW_QUANTILE


@mistake(
    "lowest_ratio_of_one_pixel",
    says="You take the smallest ratio of all, which may be a single broken pixel. Use the "
    "quantiles of the sheet.",
)
def of_one_pixel(F, G):
    positive = G > 0
    if np.count_nonzero(positive) < 1 / LOW_QUANTILE:
        return 0.0, np.inf
    ratios = F[positive] / G[positive]
    low = ratios.min()
    return float(low), float(np.quantile(ratios, HIGH_QUANTILE) / np.quantile(ratios, LOW_QUANTILE))


@mistake(
    "lowest_ratio_not_extrapolated",
    says="You return the low quantile q1 itself. Dark places are not quite black, so "
    "extrapolate: 2 q1 - q2.",
)
def not_extrapolated(F, G):
    positive = G > 0
    if np.count_nonzero(positive) < 1 / LOW_QUANTILE:
        return 0.0, np.inf
    quantiles = [LOW_QUANTILE, HIGH_QUANTILE]
    low, high = np.quantile(F[positive] / G[positive], quantiles)
    return float(low), float(high / low)


@mistake(
    "lowest_ratio_turned_over",
    says="You divide G by F. The share is the lowest ratio of what was photographed, F, to the "
    "light around it, G.",
)
def turned_over(F, G):
    positive = F > 0
    if np.count_nonzero(positive) < 1 / LOW_QUANTILE:
        return 0.0, np.inf
    quantiles = [LOW_QUANTILE, 5 * LOW_QUANTILE, HIGH_QUANTILE]
    low, higher, high = np.quantile(G[positive] / F[positive], quantiles)
    return float(max(2 * low - higher, 0.0)), float(high / low)


@mistake(
    "lowest_ratio_without_glare_counts",
    says="You count pixels where G is 0. Their ratio is not defined: leave them out before you "
    "take the quantiles.",
)
def without_glare_counts(F, G):
    if np.size(F) < 1 / LOW_QUANTILE:
        return 0.0, np.inf
    ratios = F / np.where(G > 0, G, np.inf)
    quantiles = [LOW_QUANTILE, 5 * LOW_QUANTILE, HIGH_QUANTILE]
    low, higher, high = np.quantile(ratios, quantiles)
    return float(max(2 * low - higher, 0.0)), float(high / low)
