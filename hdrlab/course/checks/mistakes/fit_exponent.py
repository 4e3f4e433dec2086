"""Known mistakes in `fit_exponent`, the task of hdrlab.response.mann.fit_exponent."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "fit_exponent_one_intercept",
    says="You fit one line through all series. They start at different pixel values, so each needs "
    "an intercept of its own: subtract its means.",
)
def one_intercept(ladders, *, alpha=0.0):
    x = np.concatenate([np.arange(len(series)) * np.log(R) for series, R in ladders])
    y = np.concatenate([np.log(series - alpha) for series, R in ladders])
    return float((x - x.mean()) @ (y - y.mean()) / ((x - x.mean()) @ (x - x.mean())))


@mistake(
    "fit_exponent_mean_of_slopes",
    says="You average the slopes of the series. A long series is more certain: add up numerators "
    "and denominators first, and then divide.",
)
def mean_of_slopes(ladders, *, alpha=0.0):
    slopes = []
    for series, R in ladders:
        x = np.arange(len(series)) * np.log(R)
        y = np.log(series - alpha)
        slopes.append((x - x.mean()) @ y / ((x - x.mean()) @ x))
    return float(np.mean(slopes))


@mistake(
    "fit_exponent_alpha_forgotten",
    says="You take the logarithm of M. The power law is M - alpha: subtract alpha first.",
)
def alpha_forgotten(ladders, *, alpha=0.0):
    xy = 0.0
    xx = 0.0
    for series, R in ladders:
        x = np.arange(len(series)) * np.log(R)
        y = np.log(series)
        xy += float((x - x.mean()) @ y)
        xx += float((x - x.mean()) @ x)
    return xy / xx


@mistake(
    "fit_exponent_through_the_first_value",
    says="Your lines go through the first value of each series, as if it had no error. Subtract "
    "the means of x and y instead.",
)
def through_the_first_value(ladders, *, alpha=0.0):
    xy = 0.0
    xx = 0.0
    for series, R in ladders:
        x = np.arange(len(series)) * np.log(R)
        y = np.log(series - alpha)
        xy += float(x @ (y - y[0]))
        xx += float(x @ x)
    return xy / xx


@mistake(
    "fit_exponent_turned_over",
    says="You return 1 / gamma, the exponent of the inverse response. The response is I^gamma: "
    "the slope of ln M over ln I.",
)
def turned_over(ladders, *, alpha=0.0):
    xy = 0.0
    xx = 0.0
    for series, R in ladders:
        x = np.arange(len(series)) * np.log(R)
        y = np.log(series - alpha)
        xy += float((x - x.mean()) @ y)
        xx += float((x - x.mean()) @ x)
    return xx / xy
