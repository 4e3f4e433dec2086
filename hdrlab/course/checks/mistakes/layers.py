"""Known mistakes in `layers`, the task of hdrlab.tonemap.durand.layers."""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.core.filters.bilateral import bilateral
from hdrlab.course.checks.mistakes import mistake
from hdrlab.tonemap.durand import Layers, fix_uncertain


@mistake(
    "layers_plain_blur",
    says="Your base is a plain blur. It crosses edges and causes halos. Weight each neighbor by "
    "its difference in lL, too.",
    misses_method=True,
)
def plain_blur(lL, *, sigma_s, sigma_r=0.4):
    base = gaussian_filter(lL, sigma_s)
    return Layers(base, lL - base)


@mistake(
    "layers_sigma_not_squared",
    says="The exponent of a Gaussian is -d^2 / (2 sigma^2). You did not square sigma, so the "
    "widths are wrong.",
)
def sigma_not_squared(lL, *, sigma_s, sigma_r=0.4):
    base = bilateral(lL, sigma_s=sigma_s**0.5, sigma_r=sigma_r**0.5).mean
    return Layers(base, lL - base)


@mistake(
    "layers_weights_not_divided",
    says="You did not divide by the sum of the weights, so the base is too small where few "
    "neighbors are similar.",
)
def weights_not_divided(lL, *, sigma_s, sigma_r=0.4):
    base = np.prod(bilateral(lL, sigma_s=sigma_s, sigma_r=sigma_r), axis=0) / (
        2 * np.pi * sigma_s**2
    )
    return Layers(base, lL - base)


@mistake(
    "layers_detail_sign",
    says="Your detail has the wrong sign. One lecture prints it, too. detail = lL - base, so that"
    " the two add up to lL.",
)
def detail_sign(lL, *, sigma_s, sigma_r=0.4):
    base = fix_uncertain(*bilateral(lL, sigma_s=sigma_s, sigma_r=sigma_r), sigma_s=sigma_s)
    return Layers(base, base - lL)
