"""Known mistakes in `adaptive_log`, the task of hdrlab.tonemap.drago.adaptive_log."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.tonemap import drago


@mistake(
    "adaptive_log_not_adapted",
    says="You use luminance as it is, so the image depends on its unit. Divide L and Lmax by the log "
    "average Lwa first.",
)
def not_adapted(L, Lwa, Lmax, *, bias=0.85):
    return drago.adaptive_log(L, 1.0, Lmax, bias=bias)


@mistake(
    "adaptive_log_brightest_not_adapted",
    says="You divide L by Lwa, but not Lmax. Then the brightest pixel is not white: Lwmax is "
    "Lmax / Lwa.",
)
def brightest_not_adapted(L, Lwa, Lmax, *, bias=0.85):
    return drago.adaptive_log(np.asarray(L) / Lwa, 1.0, Lmax, bias=bias)


@mistake(
    "adaptive_log_bias_as_the_exponent",
    says="You take the bias itself as the exponent. The exponent is ln b / ln 0.5, so that halfway "
    "the power is b.",
)
def bias_as_the_exponent(L, Lwa, Lmax, *, bias=0.85):
    return drago.adaptive_log(L, Lwa, Lmax, bias=0.5**bias)


@mistake(
    "adaptive_log_exponent_upside_down",
    says="Your exponent is ln 0.5 / ln b. It is the other way around: ln b / ln 0.5, which is below 1 "
    "for a bias above one half.",
)
def exponent_upside_down(L, Lwa, Lmax, *, bias=0.85):
    Lw = np.asarray(L) / Lwa
    Lwmax = Lmax / Lwa
    with np.errstate(divide="ignore"):
        base = 2 + 8 * (Lw / Lwmax) ** (np.log(0.5) / np.log(bias))
    return np.log(Lw + 1) / np.log(base) / np.log10(Lwmax + 1)


@mistake(
    "adaptive_log_base_up_to_12",
    says="Your base goes from 2 to 12, so that the brightest pixel is not white. It goes from 2 to 10: "
    "2 + 8 times the power.",
)
def base_up_to_12(L, Lwa, Lmax, *, bias=0.85):
    Lw = np.asarray(L) / Lwa
    Lwmax = Lmax / Lwa
    base = 2 + 10 * drago.bias_power(Lw / Lwmax, bias)
    return np.log(Lw + 1) / np.log(base) / np.log10(Lwmax + 1)


@mistake(
    "adaptive_log_natural_logarithm_below",
    says="You divide by the natural logarithm of Lwmax + 1, so the brightest pixel is 0.43 instead of "
    "1. The denominator is a logarithm to base 10.",
)
def natural_logarithm_below(L, Lwa, Lmax, *, bias=0.85):
    return drago.adaptive_log(L, Lwa, Lmax, bias=bias) / np.log(10)
