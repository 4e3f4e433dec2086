"""Known mistakes in `brightness_transfer`, the task of hdrlab.core.transfer.brightness_transfer."""

import numpy as np

from hdrlab.core.transfer import cumulate
from hdrlab.course.checks.mistakes import mistake


@mistake(
    "brightness_transfer_upper_edge",
    says="You take a cumulated count for that of its level, though it belongs to the level's "
    "upper edge: T is too high by up to one.",
)
def upper_edge(h_A, h_B):
    n = len(np.asarray(h_A))
    H_A, H_B = cumulate(h_A, n), cumulate(h_B, n)
    middle, edges = H_A[1:], np.arange(n + 1) - 0.5
    T = np.interp(middle, H_B, edges)
    return np.where((middle > 0) & (middle < 1) & (T > edges[1]) & (T <= edges[-2]), T, np.nan)


@mistake(
    "brightness_transfer_half_a_level",
    says="You put the share of the pixels below a level at that level, but a level's step "
    "reaches from half below it to half above: T is too high by a half.",
)
def half_a_level(h_A, h_B):
    n = len(np.asarray(h_A))
    H_A, H_B = cumulate(h_A, n), cumulate(h_B, n)
    middle, edges = (H_A[1:] + H_A[:-1]) / 2, np.arange(n + 1)
    T = np.interp(middle, H_B, edges)
    return np.where((middle > 0) & (middle < 1) & (T > edges[1]) & (T <= edges[-2]), T, np.nan)


@mistake(
    "brightness_transfer_other_way",
    says="Your T leads from B to A: look the ranks of A up in the cumulative histogram of B.",
)
def other_way(h_A, h_B):
    n = len(np.asarray(h_A))
    H_B, H_A = cumulate(h_A, n), cumulate(h_B, n)
    middle, edges = (H_A[1:] + H_A[:-1]) / 2, np.arange(n + 1) - 0.5
    T = np.interp(middle, H_B, edges)
    return np.where((middle > 0) & (middle < 1) & (T > edges[1]) & (T <= edges[-2]), T, np.nan)


@mistake(
    "brightness_transfer_outer_levels_taken",
    says="B's highest level holds all that is brighter, and its lowest all that is darker: T "
    "is NaN there, not a number.",
)
def outer_levels_taken(h_A, h_B):
    n = len(np.asarray(h_A))
    H_A, H_B = cumulate(h_A, n), cumulate(h_B, n)
    middle, edges = (H_A[1:] + H_A[:-1]) / 2, np.arange(n + 1) - 0.5
    T = np.interp(middle, H_B, edges)
    return np.where((middle > 0) & (middle < 1), T, np.nan)
