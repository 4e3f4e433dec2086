"""Wrong answers to tasks of homework 2. Each one breaks one sentence of its assignment, and no other.

A function's name begins with the id of its task.
"""

import numpy as np

from hdrlab.core.weights import hat
from hdrlab.fast.debevec import gsolve
from hdrlab.response.mitsunaga import recover
from hdrlab.response.robertson import recover_steps, update


def hat_of_one_value_too_few(n=256):
    return hat(n)[:-1]


def gsolve_of_g_alone(Z, B, smoothness, w):
    return gsolve(Z, B, smoothness, w).g


def gsolve_of_256_values(Z, B, smoothness, w):
    return gsolve(Z, B, smoothness, np.resize(w, 256))


def gsolve_sorts_the_times_alone(Z, B, smoothness, w):
    return gsolve(Z, np.sort(B), smoothness, w)


def irradiance_of_each_photo(Z, t, f_inv, w):
    return f_inv[Z] / t


def update_of_the_values_that_occur(Z, t, E, n=256):
    return update(Z, t, E, n)[: Z.max()]


def update_empty_is_0(Z, t, E, n=256):
    return np.nan_to_num(update(Z, t, E, n))


def recover_steps_start_not_yielded(Z, times, w, *, tolerance=0.0001, max_iterations=200):
    yield from list(recover_steps(Z, times, w, tolerance=tolerance, max_iterations=max_iterations))[
        1:
    ]


def recover_steps_small_number_below(Z, times, w, *, tolerance=0.0001, max_iterations=200):
    # as if 1 were added to the sum of w t^2: the denominator then has a unit
    t = np.asarray(times, float)
    f_inv = np.arange(256) / 128
    yield (f_inv,)
    for _ in range(max_iterations):
        E = (w[Z] * f_inv[Z]) @ t / (w[Z] @ t**2 + 1)
        means = update(Z, t, E)
        known = np.flatnonzero(~np.isnan(means))
        new = np.interp(np.arange(256), known, means[known])
        new = new / new[128]
        change = np.max(np.abs(new - f_inv))
        f_inv = new
        yield (f_inv,)
        if change < tolerance:
            return


def recover_steps_tolerance_ignored(Z, times, w, *, tolerance=0.0001, max_iterations=200):
    yield from recover_steps(Z, times, w, tolerance=0.0, max_iterations=max_iterations)


def recover_steps_always_25(Z, times, w, *, tolerance=0.0001, max_iterations=200):
    yield from recover_steps(Z, times, w, tolerance=tolerance, max_iterations=25)


def recover_of_values_that_occur(images, times, *, order=5, eps=0.001):
    return recover(images, times, order=order, eps=eps)[: np.max(images)]


def recover_assumes_sorted_photos(images, times, *, order=5, eps=0.001):
    return recover(images, np.sort(times), order=order, eps=eps)


def recover_falls_somewhere(images, times, *, order=5, eps=0.001):
    g = recover(images, times, order=order, eps=eps)
    g[100] = g[99] - 0.01
    return g


def recover_always_a_line(images, times, *, order=5, eps=0.001):
    return recover(images, times, order=1, eps=eps)
