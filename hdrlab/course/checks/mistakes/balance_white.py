"""Known mistakes in `balance_white`, the task of hdrlab.capture.development.balance_white."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "balance_white_gains_as_they_are",
    says="You use the gains as they are. Only their ratios count: divide them by the smallest first.",
)
def gains_as_they_are(X, c, gains):
    return np.minimum(X * np.asarray(gains)[c], 1)


@mistake(
    "balance_white_divided_by_the_largest",
    says="You divide the gains by the largest. Then a full pixel ends below 1 in two channels, and "
    "white gets a color cast: divide by the smallest.",
    misses_method=True,
)
def divided_by_the_largest(X, c, gains):
    g = np.asarray(gains) / np.max(gains)
    return np.minimum(X * g[c], 1)


@mistake(
    "balance_white_not_clipped",
    says="Pixels become brighter than 1, so that a full pixel is not white. Limit the result to 1.",
)
def not_clipped(X, c, gains):
    g = np.asarray(gains) / np.min(gains)
    return X * g[c]


@mistake(
    "balance_white_noise_cut_off",
    says="You cut off values below 0, so that the dark becomes too bright on average. Limit the "
    "result above only.",
)
def noise_cut_off(X, c, gains):
    g = np.asarray(gains) / np.min(gains)
    return np.clip(X * g[c], 0, 1)


@mistake(
    "balance_white_divides_by_the_gains",
    says="You divide by the gains. They are what a pixel is multiplied by.",
    misses_method=True,
)
def divides_by_the_gains(X, c, gains):
    g = np.asarray(gains) / np.min(gains)
    return np.minimum(X / g[c], 1)
