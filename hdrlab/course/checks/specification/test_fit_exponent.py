"""Checks of fit_exponent(ladders, alpha), the exponent of a power-law response: a number."""

import numpy as np

from hdrlab.course.checks.compare import points, same
from hdrlab.response import mann


def draw_inputs(rng, *, alpha=0.0, ratios=(0.5, 0.25)):
    """Return gamma and pairs (series, R) of a camera with the response alpha + beta I^gamma."""
    gamma = rng.uniform(0.35, 0.9)
    ladders = []
    for R in ratios:
        # long series begin lower, which pulls a line through all of them
        for count, top in ((3, 240), (4, 180), (5, 130)):
            top = rng.uniform(0.95, 1.05) * top
            ladders.append((alpha + top * R ** (gamma * np.arange(count)), R))
    return gamma, ladders


def same_exponent(subject, ladders, alpha=0.0, what="gamma"):
    gamma = mann.fit_exponent(ladders, alpha=alpha)
    same(subject.fit_exponent(ladders, alpha=alpha), gamma, 1e-3 * gamma, what=what)


def is_valid_input(ladders, *, alpha=0.0):
    """Return whether every series has a slope."""
    return all(len(values) >= 2 for values, _ in ladders)


@points(4)
def test_the_exponent_of_one_series_is_its_slope(subject, rng):
    """Which line is a power law on logarithmic paper?

    ln M = ln beta + gamma ln I: gamma is the slope, and each step of the series is ln R of ln I.

    Fit a straight line to ln M over k ln R, k = 0, 1, 2 ... ln R is negative.
    """
    gamma, ladders = draw_inputs(rng, ratios=(0.5,))
    same(subject.fit_exponent(ladders[:1], alpha=0.0), gamma, 1e-3 * gamma, what="gamma")


@points(5)
def test_all_series_share_one_slope_and_none_an_intercept(subject, rng):
    """The series start at different pixel values. Do their lines have the same intercept?

    No. Each has its own, so subtract each series' own means from x and y.

    gamma = sum of (x - mean x)(y - mean y) / sum of (x - mean x)^2, both sums over all series.
    """
    _, ladders = draw_inputs(rng)
    same_exponent(subject, ladders, what="gamma of six series")


@points(3)
def test_a_long_series_has_more_weight_than_short_ones(subject, rng):
    """One series has seven values, another has two. Which slope is more certain?

    The slope of the long one: its values lie further apart.

    Add up numerators and denominators over all series before you divide, instead of averaging slopes.
    """
    gamma = rng.uniform(0.4, 0.6)
    noise = np.exp([0.0, 0.04, -0.03, 0.05, 0.02, -0.04, 0.03])
    long = 230 * 0.6 ** (gamma * np.arange(7)) * noise
    short = 180 * 0.6 ** (rng.uniform(1.6, 1.9) * gamma * np.arange(2))
    same_exponent(
        subject, [(long, 0.6), (short, 0.6), (short * 1.2, 0.6)], what="gamma of unequal series"
    )


@points(3)
def test_alpha_is_subtracted_before_the_logarithm(subject, rng):
    """A photo with the lens covered has the value alpha. What follows a power law?

    Not M, but M - alpha.

    Subtract alpha from the series, and then take the logarithm.
    """
    alpha = float(rng.uniform(6, 12))
    gamma, ladders = draw_inputs(rng, alpha=alpha)
    same_exponent(subject, ladders, alpha=alpha, what="gamma with alpha above 0")
