"""Known mistakes in `fit_space`, the task of hdrlab.response.space.fit_space."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "fit_space_mean_left_in",
    says="You decompose the curves themselves, so your first component is about their mean. "
    "Subtract the mean first.",
)
def mean_left_in(curves, count):
    curves = np.asarray(curves, np.float64)
    _, S, V = np.linalg.svd(curves, full_matrices=False)
    return curves.mean(axis=0), V[:count], S[:count] / np.sqrt(len(curves))


@mistake(
    "fit_space_singular_values",
    says="Your sd grows with the number of curves: it is the singular value. Divide it by sqrt(C).",
)
def singular_values(curves, count):
    curves = np.asarray(curves, np.float64)
    mean = curves.mean(axis=0)
    _, S, V = np.linalg.svd(curves - mean, full_matrices=False)
    return mean, V[:count], S[:count]


@mistake(
    "fit_space_variances",
    says="Your sd is a variance. Take the square root.",
)
def variances(curves, count):
    curves = np.asarray(curves, np.float64)
    mean = curves.mean(axis=0)
    _, S, V = np.linalg.svd(curves - mean, full_matrices=False)
    return mean, V[:count], S[:count] ** 2 / len(curves)


@mistake(
    "fit_space_smallest_first",
    says="Your components are those along which the curves spread least, or in the wrong order. "
    "Begin with the largest singular value.",
)
def smallest_first(curves, count):
    curves = np.asarray(curves, np.float64)
    mean = curves.mean(axis=0)
    _, S, V = np.linalg.svd(curves - mean, full_matrices=False)
    return mean, V[:count][::-1], S[:count][::-1] / np.sqrt(len(curves))


@mistake(
    "fit_space_components_scaled",
    says="Your components contain their spread. The rows of H have length 1; the spread is in sd.",
)
def components_scaled(curves, count):
    curves = np.asarray(curves, np.float64)
    mean = curves.mean(axis=0)
    _, S, V = np.linalg.svd(curves - mean, full_matrices=False)
    sd = S[:count] / np.sqrt(len(curves))
    return mean, sd[:, None] * V[:count], sd
