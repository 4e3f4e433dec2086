"""Known mistakes in `remap`, the task of hdrlab.tonemap.local_laplacian.remap."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "remap_not_in_sigmas",
    says="You take the power of d itself. Divide d by sigma before you raise it to alpha, so "
    "that sigma stays sigma.",
)
def not_in_sigmas(lL, g, *, sigma, alpha, beta):
    d = np.abs(lL - g)
    detail = np.minimum(d, sigma) ** alpha
    edge = beta * np.maximum(d - sigma, 0)
    return g + np.sign(lL - g) * (detail + edge)


@mistake(
    "remap_edges_jump",
    says="Beyond sigma you leave out the first sigma of the edge, so r jumps back to g there. "
    "Add sigma to beta (d - sigma).",
)
def edges_jump(lL, g, *, sigma, alpha, beta):
    d = np.abs(lL - g)
    detail = sigma * np.where(d <= sigma, d / sigma, 0) ** alpha
    edge = beta * np.maximum(d - sigma, 0)
    return g + np.sign(lL - g) * (detail + edge)


@mistake(
    "remap_beta_of_the_whole",
    says="You multiply the whole difference by beta. Multiply only the part beyond sigma: beta (d"
    " - sigma).",
)
def beta_of_the_whole(lL, g, *, sigma, alpha, beta):
    d = np.abs(lL - g)
    detail = sigma * np.minimum(d / sigma, 1) ** alpha
    edge = np.where(d > sigma, beta * d, 0)
    return g + np.sign(lL - g) * (detail + edge)


@mistake(
    "remap_alpha_inverted",
    says="Your details grow where they should shrink: the power is alpha, not 1 / alpha.",
)
def alpha_inverted(lL, g, *, sigma, alpha, beta):
    d = np.abs(lL - g)
    detail = sigma * np.minimum(d / sigma, 1) ** (1 / alpha)
    edge = beta * np.maximum(d - sigma, 0)
    return g + np.sign(lL - g) * (detail + edge)
