"""Known mistakes in `brightness_transfer`, the task of hdrlab.core.transfer.brightness_transfer."""

import numpy as np

from hdrlab.core.transfer import cumulate
from hdrlab.course.checks.mistakes import mistake


@mistake(
    "brightness_transfer_upper_edge",
    says="You assign a cumulative count to the middle of its pixel value, but it belongs to the "
    "upper edge. T is too high by up to 1.",
)
def upper_edge(h_A, h_B):
    n = len(np.asarray(h_A))
    H_A = cumulate(h_A, n)
    H_B = cumulate(h_B, n)
    middle = H_A[1:]
    edges = np.arange(n + 1) - 0.5
    T = np.interp(middle, H_B, edges)
    return np.where((middle > 0) & (middle < 1) & (T > edges[1]) & (T <= edges[-2]), T, np.nan)


@mistake(
    "brightness_transfer_half_a_level",
    says="You place the lower edge of pixel value z at z, but it is at z - 1/2. So your T is too "
    "high by a half.",
)
def half_a_level(h_A, h_B):
    n = len(np.asarray(h_A))
    H_A = cumulate(h_A, n)
    H_B = cumulate(h_B, n)
    middle = (H_A[1:] + H_A[:-1]) / 2
    edges = np.arange(n + 1)
    T = np.interp(middle, H_B, edges)
    return np.where((middle > 0) & (middle < 1) & (T > edges[1]) & (T <= edges[-2]), T, np.nan)


@mistake(
    "brightness_transfer_other_way",
    says="Your T maps from B to A. Look up the ranks of A in the cumulative histogram of B.",
)
def other_way(h_A, h_B):
    n = len(np.asarray(h_A))
    H_B = cumulate(h_A, n)
    H_A = cumulate(h_B, n)
    middle = (H_A[1:] + H_A[:-1]) / 2
    edges = np.arange(n + 1) - 0.5
    T = np.interp(middle, H_B, edges)
    return np.where((middle > 0) & (middle < 1) & (T > edges[1]) & (T <= edges[-2]), T, np.nan)


@mistake(
    "brightness_transfer_outer_levels_taken",
    says="The highest value of B contains everything brighter, and the lowest everything darker. "
    "T must be NaN there, not a number.",
)
def outer_levels_taken(h_A, h_B):
    n = len(np.asarray(h_A))
    H_A = cumulate(h_A, n)
    H_B = cumulate(h_B, n)
    middle = (H_A[1:] + H_A[:-1]) / 2
    edges = np.arange(n + 1) - 0.5
    T = np.interp(middle, H_B, edges)
    return np.where((middle > 0) & (middle < 1), T, np.nan)
