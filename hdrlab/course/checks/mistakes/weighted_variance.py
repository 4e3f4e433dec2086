"""Known mistakes in the task `weighted_variance`."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "weighted_variance_plain_mean",
    says="You subtract the plain mean of x. Subtract the weighted mean, sum w x / sum w, so "
    "that a clipped photo does not shift it.",
)
def plain_mean(x, w):
    total = np.maximum(w.sum(axis=0), 1e-30)
    m = x.mean(axis=0)
    return (w * (x - m) ** 2).sum(axis=0) / total


@mistake(
    "weighted_variance_mean_left_in",
    says="You average the squares of x itself, which depends on the unit of light. Subtract "
    "the mean from x first.",
)
def mean_left_in(x, w):
    total = np.maximum(w.sum(axis=0), 1e-30)
    return (w * x**2).sum(axis=0) / total


@mistake(
    "weighted_variance_root",
    says="You return the standard deviation. Return the variance, without the square root.",
)
def root(x, w):
    total = np.maximum(w.sum(axis=0), 1e-30)
    m = (w * x).sum(axis=0) / total
    return np.sqrt((w * (x - m) ** 2).sum(axis=0) / total)


@mistake(
    "weighted_variance_root_about_the_plain_mean",
    says="Subtract the weighted mean of x, not the plain one, and return the variance without the "
    "square root.",
)
def root_about_the_plain_mean(x, w):
    total = np.maximum(w.sum(axis=0), 1e-30)
    return np.sqrt((w * (x - x.mean(axis=0)) ** 2).sum(axis=0) / total)
