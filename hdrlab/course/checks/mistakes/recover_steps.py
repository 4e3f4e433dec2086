"""Known mistakes in `recover_steps`, the task of hdrlab.response.robertson.recover_steps."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.response.robertson import State, alternate, fill, irradiance, linear


@mistake(
    "recover_steps_weighted_update",
    says="Your iterations use weights in the update of f^-1. The update is a plain mean; only the "
    "irradiance is a weighted one.",
)
def weighted_update(Z, times, w, *, tolerance=0.0001, max_iterations=200):
    def alternate(Z, t, w):
        def means(f_inv):
            E = irradiance(Z, t, f_inv, w)
            known = ~np.isnan(E)
            T = np.broadcast_to(t**2, Z[known].shape)
            above = np.bincount(Z[known].ravel(), (E[known, None] * t * T).ravel(), len(w))
            return above / np.bincount(Z[known].ravel(), T.ravel(), len(w))

        return means

    t = np.asarray(times, np.float64) / np.max(times)
    means = alternate(Z, t, w)
    f_inv = linear(len(w))
    yield State(f_inv, np.inf)
    for _ in range(max_iterations):
        new = fill(means(f_inv), w)
        new = new / new[len(w) // 2]
        change = float(np.max(np.abs(new - f_inv)))
        f_inv = new
        yield State(f_inv, change)
        if change < tolerance:
            return


@mistake(
    "recover_steps_exponential_start",
    says="You start with an exponential. Its shape remains where the photos do not constrain the "
    "curve. Start with a line.",
)
def exponential_start(Z, times, w, *, tolerance=0.0001, max_iterations=200):
    def linear(n=256):
        return np.exp((np.arange(n) - n // 2) / 50)

    t = np.asarray(times, np.float64) / np.max(times)
    means = alternate(Z, t, w)
    f_inv = linear(len(w))
    yield State(f_inv, np.inf)
    for _ in range(max_iterations):
        new = fill(means(f_inv), w)
        new = new / new[len(w) // 2]
        change = float(np.max(np.abs(new - f_inv)))
        f_inv = new
        yield State(f_inv, change)
        if change < tolerance:
            return


@mistake(
    "recover_steps_empty_left_at_0",
    says="Pixel values without pixels stay 0 in your response. Fill them from their neighbors; "
    "otherwise later iterations use 0 there.",
)
def empty_left_at_0(Z, times, w, *, tolerance=0.0001, max_iterations=200):
    t = np.asarray(times, np.float64) / np.max(times)
    means = alternate(Z, t, w)
    f_inv = linear(len(w))
    yield State(f_inv, np.inf)
    for _ in range(max_iterations):
        new = np.nan_to_num(means(f_inv))
        new = new / (new[len(w) // 2] or 1)
        change = float(np.max(np.abs(new - f_inv)))
        f_inv = new
        yield State(f_inv, change)
        if change < tolerance:
            return


@mistake(
    "recover_steps_one_turn",
    says="You stop after one iteration. A new f^-1 gives a better E, and a better E gives a "
    "better f^-1. Iterate until f^-1 hardly changes.",
    misses_method=True,
)
def one_turn(Z, times, w, *, tolerance=0.0001, max_iterations=200):
    t = np.asarray(times, np.float64) / np.max(times)
    means = alternate(Z, t, w)
    f_inv = linear(len(w))
    yield State(f_inv, np.inf)
    for _ in range(max_iterations):
        new = fill(means(f_inv), w)
        new = new / new[len(w) // 2]
        change = float(np.max(np.abs(new - f_inv)))
        f_inv = new
        yield State(f_inv, change)
        return
