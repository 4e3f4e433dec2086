"""Known mistakes in `guided`, the task of hdrlab.core.filters.guided.guided."""

import numpy as np
from scipy.ndimage import uniform_filter

from hdrlab.core.filters.guided import Lines, lines, window_mean
from hdrlab.course.checks.mistakes import mistake


@mistake(
    "guided_lines_not_averaged",
    says="You use only the line of the window around each pixel. Each pixel is in many "
    "windows: average their a and b.",
)
def lines_not_averaged(I, p=None, *, radius, epsilon):
    I = np.asarray(I, np.float64)
    p = I if p is None else np.asarray(p, np.float64)
    a, b = lines(I, p, radius=radius, epsilon=epsilon)
    return a * I + b


@mistake(
    "guided_variance_for_covariance",
    says="Your slope is var(I) / (var(I) + eps), whatever p is. The numerator is the "
    "covariance of I and p.",
)
def variance_for_covariance(I, p=None, *, radius, epsilon):
    def lines(I, p, *, radius, epsilon):
        mean_I = window_mean(I, radius)
        mean_p = window_mean(p, radius)
        cov = window_mean(I * I, radius) - mean_I**2
        var = window_mean(I * I, radius) - mean_I**2
        a = cov / (var + epsilon)
        return Lines(a, mean_p - a * mean_I)

    I = np.asarray(I, np.float64)
    p = I if p is None else np.asarray(p, np.float64)
    a, b = lines(I, p, radius=radius, epsilon=epsilon)
    return window_mean(a, radius) * I + window_mean(b, radius)


@mistake(
    "guided_epsilon_squared",
    says="epsilon is a variance already, in squared units of I: do not square it.",
)
def epsilon_squared(I, p=None, *, radius, epsilon):
    def lines(I, p, *, radius, epsilon):
        mean_I = window_mean(I, radius)
        mean_p = window_mean(p, radius)
        cov = window_mean(I * p, radius) - mean_I * mean_p
        var = window_mean(I * I, radius) - mean_I**2
        a = cov / (var + epsilon**2)
        return Lines(a, mean_p - a * mean_I)

    I = np.asarray(I, np.float64)
    p = I if p is None else np.asarray(p, np.float64)
    a, b = lines(I, p, radius=radius, epsilon=epsilon)
    return window_mean(a, radius) * I + window_mean(b, radius)


@mistake(
    "guided_window_of_radius",
    says="Your windows are r pixels wide. r is a radius: the square has 2 r + 1 pixels on a side.",
)
def window_of_radius(I, p=None, *, radius, epsilon):
    def window_mean(v, radius):
        total, count = (uniform_filter(x, radius, mode="constant") for x in (v, np.ones_like(v)))
        return total / count

    def lines(I, p, *, radius, epsilon):
        mean_I = window_mean(I, radius)
        mean_p = window_mean(p, radius)
        cov = window_mean(I * p, radius) - mean_I * mean_p
        var = window_mean(I * I, radius) - mean_I**2
        a = cov / (var + epsilon)
        return Lines(a, mean_p - a * mean_I)

    I = np.asarray(I, np.float64)
    p = I if p is None else np.asarray(p, np.float64)
    a, b = lines(I, p, radius=radius, epsilon=epsilon)
    return window_mean(a, radius) * I + window_mean(b, radius)


@mistake(
    "guided_line_of_the_picture",
    says="You apply the line to p. q is a linear function of the guide I, whose edges it gets: "
    "mean(a) I + mean(b).",
)
def line_of_the_picture(I, p=None, *, radius, epsilon):
    I = np.asarray(I, np.float64)
    p = I if p is None else np.asarray(p, np.float64)
    a, b = lines(I, p, radius=radius, epsilon=epsilon)
    return window_mean(a, radius) * p + window_mean(b, radius)
