"""Known mistakes in `variance`, the task of hdrlab.radiance.uncertainty.variance."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "variance_read_noise_in_electrons",
    says="R is in electrons, and V is the variance of the exposure. Divide R by N before you "
    "square it.",
)
def read_noise_in_electrons(X, D, N, R):
    N = np.asarray(N, np.float64)
    R = np.asarray(R, np.float64)
    return X / N + R**2 + D**2 / 12


@mistake(
    "variance_read_noise_not_squared",
    says="R is a standard deviation. Only variances add up: square R / N.",
)
def read_noise_not_squared(X, D, N, R):
    N = np.asarray(N, np.float64)
    R = np.asarray(R, np.float64)
    return X / N + R / N + D**2 / 12


@mistake(
    "variance_photons_not_divided_twice",
    says="X N is the variance of the count. The exposure is the count over N, so its variance "
    "is X N / N^2: divide by N twice.",
)
def photons_not_divided_twice(X, D, N, R):
    N = np.asarray(N, np.float64)
    R = np.asarray(R, np.float64)
    return X + (R / N) ** 2 + D**2 / 12


@mistake(
    "variance_rounding_of_a_whole_step",
    says="You add D^2. The exposure is spread evenly over one step D, so its variance is D^2 / 12.",
)
def rounding_of_a_whole_step(X, D, N, R):
    N = np.asarray(N, np.float64)
    R = np.asarray(R, np.float64)
    return X / N + (R / N) ** 2 + D**2


@mistake(
    "variance_rounding_once",
    says="You did not square the step D. Rounding adds D^2 / 12.",
)
def rounding_once(X, D, N, R):
    N = np.asarray(N, np.float64)
    R = np.asarray(R, np.float64)
    return X / N + (R / N) ** 2 + D / 12
