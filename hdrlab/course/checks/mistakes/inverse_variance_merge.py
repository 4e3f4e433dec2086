"""Known mistakes in the task `inverse_variance_merge`."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.radiance.uncertainty import REWEIGHTING_ROUNDS, variance


@mistake(
    "inverse_variance_merge_by_what_was_counted",
    says="You compute V from each photo's own count, so one that counted too few photons by "
    "chance gets too much weight. Compute it from E t.",
)
def by_what_was_counted(X, D, measured, t, N, R):
    t = np.reshape(np.asarray(t, np.float64), (-1,) + (1,) * (X.ndim - 1))
    E = X / t
    with np.errstate(divide="ignore", invalid="ignore"):
        for _ in range(1):
            V = np.where(measured, variance(E * t, D, N, R) / t**2, np.inf)
            E = np.sum(X / t / V, axis=0) / np.sum(1 / V, axis=0)
        return E, 1 / np.sqrt(np.sum(1 / V, axis=0))


@mistake(
    "inverse_variance_merge_times_forgotten",
    says="You weight by the variance of X. You average X / t, whose variance is V / t^2.",
)
def times_forgotten(X, D, measured, t, N, R):
    t = np.reshape(np.asarray(t, np.float64), (-1,) + (1,) * (X.ndim - 1))
    E = X / t
    with np.errstate(divide="ignore", invalid="ignore"):
        for _ in range(1 + REWEIGHTING_ROUNDS):
            V = np.where(measured, variance(E * t, D, N, R), np.inf)
            E = np.sum(X / t / V, axis=0) / np.sum(1 / V, axis=0)
        return E, 1 / np.sqrt(np.sum(1 / V, axis=0))


@mistake(
    "inverse_variance_merge_time_once",
    says="The variance of X / t is the variance of X divided by t squared. You divide by t once.",
)
def time_once(X, D, measured, t, N, R):
    t = np.reshape(np.asarray(t, np.float64), (-1,) + (1,) * (X.ndim - 1))
    E = X / t
    with np.errstate(divide="ignore", invalid="ignore"):
        for _ in range(1 + REWEIGHTING_ROUNDS):
            V = np.where(measured, variance(E * t, D, N, R) / t, np.inf)
            E = np.sum(X / t / V, axis=0) / np.sum(1 / V, axis=0)
        return E, 1 / np.sqrt(np.sum(1 / V, axis=0))


@mistake(
    "inverse_variance_merge_inverse_deviation",
    says="You weight by the inverse standard deviation. The inverse variance gives the "
    "smallest error of all weights.",
)
def inverse_deviation(X, D, measured, t, N, R):
    t = np.reshape(np.asarray(t, np.float64), (-1,) + (1,) * (X.ndim - 1))
    E = X / t
    with np.errstate(divide="ignore", invalid="ignore"):
        for _ in range(1 + REWEIGHTING_ROUNDS):
            V = np.where(measured, variance(E * t, D, N, R) / t**2, np.inf)
            E = np.sum(X / t / np.sqrt(V), axis=0) / np.sum(1 / np.sqrt(V), axis=0)
        return E, 1 / np.sqrt(np.sum(1 / V, axis=0))


@mistake(
    "inverse_variance_merge_root_forgotten",
    says="You return the variance. s is a standard deviation, its square root: 1 / sqrt(sum 1 "
    "/ V).",
)
def root_forgotten(X, D, measured, t, N, R):
    t = np.reshape(np.asarray(t, np.float64), (-1,) + (1,) * (X.ndim - 1))
    E = X / t
    with np.errstate(divide="ignore", invalid="ignore"):
        for _ in range(1 + REWEIGHTING_ROUNDS):
            V = np.where(measured, variance(E * t, D, N, R) / t**2, np.inf)
            E = np.sum(X / t / V, axis=0) / np.sum(1 / V, axis=0)
        return E, 1 / np.sum(1 / V, axis=0)


@mistake(
    "inverse_variance_merge_clipped_count",
    says="You use photos that do not measure the pixel. Where `measured` is False, 1 / V is 0.",
)
def clipped_count(X, D, measured, t, N, R):
    t = np.reshape(np.asarray(t, np.float64), (-1,) + (1,) * (X.ndim - 1))
    E = X / t
    with np.errstate(divide="ignore", invalid="ignore"):
        for _ in range(1 + REWEIGHTING_ROUNDS):
            V = variance(E * t, D, N, R) / t**2
            E = np.sum(X / t / V, axis=0) / np.sum(1 / V, axis=0)
        return E, 1 / np.sqrt(np.sum(1 / V, axis=0))


@mistake(
    "inverse_variance_merge_best_alone",
    says="Your s is that of the best photo alone. All photos together are more precise: s^2 = 1 /"
    " sum (1 / V).",
)
def best_alone(X, D, measured, t, N, R):
    t = np.reshape(np.asarray(t, np.float64), (-1,) + (1,) * (X.ndim - 1))
    E = X / t
    with np.errstate(divide="ignore", invalid="ignore"):
        for _ in range(1 + REWEIGHTING_ROUNDS):
            V = np.where(measured, variance(E * t, D, N, R) / t**2, np.inf)
            E = np.sum(X / t / V, axis=0) / np.sum(1 / V, axis=0)
        return E, np.sqrt(np.min(V, axis=0))


@mistake(
    "inverse_variance_merge_plain_mean",
    says="You take the plain mean, so each photo counts the same. Weight each by its inverse "
    "variance, 1 / V.",
    misses_method=True,
)
def plain_mean(X, D, measured, t, N, R):
    t = np.reshape(np.asarray(t, np.float64), (-1,) + (1,) * (X.ndim - 1))
    E = X / t
    with np.errstate(divide="ignore", invalid="ignore"):
        for _ in range(1 + REWEIGHTING_ROUNDS):
            V = np.where(measured, variance(E * t, D, N, R) / t**2, np.inf)
            E = np.sum(np.where(measured, X / t, 0), axis=0) / measured.sum(axis=0)
        return E, np.sqrt(np.sum(np.where(measured, V, 0), axis=0)) / measured.sum(axis=0)
