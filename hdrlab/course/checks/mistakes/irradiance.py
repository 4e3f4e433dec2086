"""Known mistakes in `irradiance`, the task of hdrlab.response.robertson.irradiance."""

import numpy as np

from hdrlab.course.checks.mistakes import Question, mistake


@mistake(
    "irradiance_black_where_clipped",
    says="If no photo measures the sample, its irradiance is unknown. You return 0, which would "
    "make the sun black. Return NaN.",
    questions=(
        Question(
            code="f_inv = np.array([0.0, 1.0, 2.0])\n"
            "w = np.array([0.0, 1.0, 0.0])\n"
            "irradiance(np.array([[1]]), np.array([2.0]), f_inv, w)[0]",
            why="1 · 2 · 1 / (1 · 4): an exposure of 1 in 2 s.",
            because=r"$$E_i = \frac",
        ),
        Question(
            code="f_inv = np.array([0.0, 1.0, 2.0])\n"
            "w = np.array([0.0, 1.0, 0.0])\n"
            "irradiance(np.array([[2]]), np.array([2.0]), f_inv, w)[0]",
            why="The value 2 has the weight 0, and there is no other photo: 0 / 0.",
            because="If all weights of a sample are 0",
        ),
        Question(
            code="f_inv = np.array([0.0, 1.0, 2.0])\n"
            "w = np.array([0.0, 1.0, 0.0])\n"
            "irradiance(np.array([[0, 2]]), np.array([1.0, 4.0]), f_inv, w)[0]",
            why="One photo is black and the other one is clipped. Both have the weight 0, "
            "so nothing is known.",
            because="If all weights of a sample are 0",
        ),
    ),
    fixes=(
        ("np.nan_to_num", "np.asarray"),
        ("+ eps", ""),
    ),
)
def black_where_clipped(Z, t, f_inv, w):
    with np.errstate(invalid="ignore"):
        return np.nan_to_num((w[Z] * f_inv[Z]) @ t / (w[Z] @ t**2))


@mistake(
    "irradiance_not_weighted",
    says="You forgot the weights. Clipped pixels count like all others, so bright irradiances are"
    " too low.",
)
def not_weighted(Z, t, f_inv, w):
    with np.errstate(invalid="ignore"):
        return f_inv[Z] @ t / (t**2).sum()


@mistake(
    "irradiance_time_below_alone",
    says="The time belongs in the numerator, too: sum w f t / sum w t^2.",
)
def time_below_alone(Z, t, f_inv, w):
    with np.errstate(invalid="ignore"):
        return (w[Z] * f_inv[Z]).sum(axis=1) / (w[Z] @ t**2)


@mistake(
    "irradiance_time_once",
    says="The time is squared in the denominator: sum w t^2. Your fraction is the sum of the "
    "exposures over the sum of the times.",
)
def time_once(Z, t, f_inv, w):
    with np.errstate(invalid="ignore"):
        return (w[Z] * f_inv[Z]).sum(axis=1) / (w[Z] @ t)


@mistake(
    "irradiance_mean_of_the_quotients",
    says="You average f^-1(Z) / t with the weights w alone. A long exposure is more precise: its "
    "weight is w t^2.",
)
def mean_of_the_quotients(Z, t, f_inv, w):
    with np.errstate(invalid="ignore"):
        return (w[Z] * f_inv[Z] / t).sum(axis=1) / w[Z].sum(axis=1)
