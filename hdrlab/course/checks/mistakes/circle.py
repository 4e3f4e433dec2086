"""Known mistakes in `circle`, the task of hdrlab.response.selection.circle."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.response.selection import radius


def find_end(miss, usable, r, rings, tolerance, in_a_row=2):
    """Return the inner radius of the first rings in a row whose median is off."""
    outer = r.max()
    edges = np.linspace(outer / 4, outer, rings + 1)
    off = np.zeros(rings + 1, bool)
    for i in range(rings):
        ring = miss[usable & (r >= edges[i]) & (r < edges[i + 1])]
        off[i] = len(ring) > 0 and abs(np.median(ring)) > tolerance
    off[-1] = off[-2]
    ends = np.flatnonzero(off[:-1] & off[1:] if in_a_row == 2 else off)
    return float(edges[ends[0]] if len(ends) else outer)


def predict(a, b, learned_from):
    """Return B of each pixel's value in A, learned from some pixels, and where it is known."""
    count = np.bincount(a[learned_from].astype(int), minlength=256)
    known = np.flatnonzero(count)
    T = np.bincount(a[learned_from].astype(int), b[learned_from], 256)[known] / count[known]
    return np.interp(a, known, T), (a >= known[0]) & (a <= known[-1])


@mistake(
    "circle_photos_compared_directly",
    says="You compare B with A itself, but the photos have different exposures. Learn from the "
    "middle which value of B belongs to each value of A.",
)
def photos_compared_directly(A, B, tolerance=1.0, rings=40):
    a = np.asarray(A, np.float64)
    b = np.asarray(B, np.float64)
    usable = (a > 4) & (a < 250) & (b > 4) & (b < 250)
    return find_end(b - a, usable, radius(a.shape), rings, tolerance)


@mistake(
    "circle_one_factor",
    says="You multiply A by one factor to predict B. The response is curved, so the factor differs "
    "from value to value. Learn from the middle which value of B belongs to each value of A.",
)
def one_factor(A, B, tolerance=1.0, rings=40):
    a = np.asarray(A, np.float64)
    b = np.asarray(B, np.float64)
    r = radius(a.shape)
    usable = (a > 4) & (a < 250) & (b > 4) & (b < 250)
    middle = usable & (r < r.max() / 4)
    factor = b[middle].mean() / a[middle].mean()
    return find_end(b - factor * a, usable, r, rings, tolerance)


@mistake(
    "circle_clipped_pixels_count",
    says="You count clipped pixels, of which B says nothing. Use values from 5 to 249 in both photos.",
)
def clipped_pixels_count(A, B, tolerance=1.0, rings=40):
    a = np.asarray(A, np.float64)
    b = np.asarray(B, np.float64)
    r = radius(a.shape)
    predicted, is_known = predict(a, b, r < r.max() / 4)
    return find_end(b - predicted, is_known, r, rings, tolerance)


@mistake(
    "circle_one_ring_is_enough",
    says="Your circle ends at a single ring, in which something may have moved. Wait for two "
    "adjacent rings.",
)
def one_ring_is_enough(A, B, tolerance=1.0, rings=40):
    a = np.asarray(A, np.float64)
    b = np.asarray(B, np.float64)
    r = radius(a.shape)
    usable = (a > 4) & (a < 250) & (b > 4) & (b < 250)
    predicted, is_known = predict(a, b, usable & (r < r.max() / 4))
    return find_end(b - predicted, usable & is_known, r, rings, tolerance, in_a_row=1)


@mistake(
    "circle_fraction",
    says="You return the radius as a fraction of the largest one. Return pixels.",
)
def fraction(A, B, tolerance=1.0, rings=40):
    a = np.asarray(A, np.float64)
    b = np.asarray(B, np.float64)
    r = radius(a.shape)
    usable = (a > 4) & (a < 250) & (b > 4) & (b < 250)
    predicted, is_known = predict(a, b, usable & (r < r.max() / 4))
    return find_end(b - predicted, usable & is_known, r, rings, tolerance) / r.max()


@mistake(
    "circle_default_tolerance",
    says="You always allow one pixel value. Use the argument `tolerance`.",
)
def default_tolerance(A, B, tolerance=1.0, rings=40):
    a = np.asarray(A, np.float64)
    b = np.asarray(B, np.float64)
    r = radius(a.shape)
    usable = (a > 4) & (a < 250) & (b > 4) & (b < 250)
    predicted, is_known = predict(a, b, usable & (r < r.max() / 4))
    return find_end(b - predicted, usable & is_known, r, rings, 1.0)
