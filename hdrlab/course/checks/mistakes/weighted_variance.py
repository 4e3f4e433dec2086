"""Known mistakes in the task `weighted_variance`."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "weighted_variance_plain_mean",
    says="You take the differences from the plain mean of x: take the weighted one, sum w x / "
    "sum w, lest a clipped frame shift it.",
)
def plain_mean(x, w):
    total = np.maximum(w.sum(axis=0), 1e-30)
    m = x.mean(axis=0)
    return (w * (x - m) ** 2).sum(axis=0) / total


@mistake(
    "weighted_variance_mean_left_in",
    says="Yours is the mean of the squares of x itself, which depends on the unit of light: "
    "take the mean off x first.",
)
def mean_left_in(x, w):
    total = np.maximum(w.sum(axis=0), 1e-30)
    return (w * x**2).sum(axis=0) / total


@mistake(
    "weighted_variance_root",
    says="You answer the standard deviation: asked is the variance, without the root.",
)
def root(x, w):
    total = np.maximum(w.sum(axis=0), 1e-30)
    m = (w * x).sum(axis=0) / total
    return np.sqrt((w * (x - m) ** 2).sum(axis=0) / total)
