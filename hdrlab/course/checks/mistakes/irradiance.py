"""Known mistakes in `irradiance`, the task of hdrlab.response.robertson.irradiance."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "irradiance_black_where_clipped",
    says="Where no frame saw the sample well nothing is known of it. You answer 0, which is "
    "the darkest there is: a dark sun.",
)
def black_where_clipped(Z, t, f_inv, w):
    with np.errstate(invalid="ignore"):
        return np.nan_to_num((w[Z] * f_inv[Z]) @ t / (w[Z] @ t**2))


@mistake(
    "irradiance_not_weighted",
    says="Without weights clipped pixels count like all others, and pull bright irradiances down.",
)
def not_weighted(Z, t, f_inv, w):
    with np.errstate(invalid="ignore"):
        return f_inv[Z] @ t / (t**2).sum()


@mistake(
    "irradiance_time_below_alone",
    says="The time belongs above the fraction as well: sum w f t over sum w t^2.",
)
def time_below_alone(Z, t, f_inv, w):
    with np.errstate(invalid="ignore"):
        return (w[Z] * f_inv[Z]).sum(axis=1) / (w[Z] @ t**2)


@mistake(
    "irradiance_time_once",
    says="Below the fraction the time is squared: sum w t^2. Yours weights frames as if all "
    "light were counted in one bin.",
)
def time_once(Z, t, f_inv, w):
    with np.errstate(invalid="ignore"):
        return (w[Z] * f_inv[Z]).sum(axis=1) / (w[Z] @ t)
