"""Known mistakes in `remap`, the task of hdrlab.tonemap.local_laplacian.remap."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.tonemap.local_laplacian import detail_weight


def power(d, x, alpha):
    """Return x^alpha, and near noise a mean of it and x, as the task asks for."""
    if alpha >= 1:
        return x**alpha
    tau = detail_weight(d)
    return tau * x**alpha + (1 - tau) * x


@mistake(
    "remap_not_in_sigmas",
    says="You take the power of d itself. Divide d by sigma before you raise it to alpha, so "
    "that sigma stays sigma.",
)
def not_in_sigmas(lL, g, *, sigma, alpha, beta):
    d = np.abs(lL - g)
    detail = power(d, np.minimum(d, sigma), alpha)
    edge = beta * np.maximum(d - sigma, 0)
    return g + np.sign(lL - g) * (detail + edge)


@mistake(
    "remap_edges_jump",
    says="Beyond sigma you leave out the first sigma of the edge, so r jumps back to g there. "
    "Add sigma to beta (d - sigma).",
)
def edges_jump(lL, g, *, sigma, alpha, beta):
    d = np.abs(lL - g)
    detail = sigma * power(d, np.where(d <= sigma, d / sigma, 0), alpha)
    edge = beta * np.maximum(d - sigma, 0)
    return g + np.sign(lL - g) * (detail + edge)


@mistake(
    "remap_beta_of_the_whole",
    says="You multiply the whole difference by beta. Multiply only the part beyond sigma: beta (d"
    " - sigma).",
)
def beta_of_the_whole(lL, g, *, sigma, alpha, beta):
    d = np.abs(lL - g)
    detail = sigma * power(d, np.minimum(d / sigma, 1), alpha)
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


@mistake(
    "remap_noise_amplified",
    says="For alpha below 1 you amplify noise: the slope of the power is infinite at g. Blend it "
    "with d / sigma by tau where d is below 0.02.",
)
def noise_amplified(lL, g, *, sigma, alpha, beta):
    d = np.abs(lL - g)
    detail = sigma * np.minimum(d / sigma, 1) ** alpha
    edge = beta * np.maximum(d - sigma, 0)
    return g + np.sign(lL - g) * (detail + edge)


@mistake(
    "remap_noise_measured_in_sigmas",
    says="You compute tau from d / sigma. Noise does not grow with sigma: compute it from d, in nats.",
)
def noise_measured_in_sigmas(lL, g, *, sigma, alpha, beta):
    d = np.abs(lL - g)
    x = np.minimum(d / sigma, 1)
    edge = beta * np.maximum(d - sigma, 0)
    return g + np.sign(lL - g) * (sigma * power(x, x, alpha) + edge)
