"""The exponent of a Gaussian is -d^2 / (2 sigma^2); yours has sigma where its square belongs, so the
widths are not those asked for."""

from hdrlab.core.filters.bilateral import bilateral


def layers(lL, *, sigma_s, sigma_r=0.4):
    base = bilateral(lL, sigma_s=sigma_s**0.5, sigma_r=sigma_r**0.5).mean
    return base, lL - base
