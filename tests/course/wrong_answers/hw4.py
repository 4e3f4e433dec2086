"""Wrong answers to tasks of homework 4. Each one breaks one sentence of its assignment, and no other.

A function's name begins with the id of its task.
"""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.core.filters.bilateral import bilateral
from hdrlab.core.filters.poisson import divergence, solve
from hdrlab.tonemap.chiu import scale
from hdrlab.tonemap.durand import layers
from hdrlab.tonemap.fattal import attenuation_steps
from hdrlab.tonemap.reinhard import display, scale_steps
from hdrlab.tonemap.ward import adjust_steps


def log_average_of_each_row(L, *, delta=1e-6):
    return np.exp(np.log(L + delta).mean(axis=1))


def display_white_is_the_brightest(Lm, adaptation, white=None):
    return display(Lm, adaptation, Lm.max() if white is None else white)


def scale_steps_of_the_surround(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    for k, state in enumerate(scale_steps(blurred, key=key, phi=phi, threshold=threshold)):
        adaptation = np.where(state.even, blurred[k + 1], state.adaptation)
        yield *state[:4], adaptation


def scale_steps_0_if_none_is_even(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    ever = None
    for state in scale_steps(blurred, key=key, phi=phi, threshold=threshold):
        ever = state.even if ever is None else ever
        yield *state[:4], np.where(ever, state.adaptation, 0)


def scale_steps_of_defaults(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    yield from scale_steps(blurred)


def scale_steps_all_but_the_last(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    yield from scale_steps(blurred[:-1], key=key, phi=phi, threshold=threshold)


def scale_steps_even_here_alone(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    for state in scale_steps(blurred, key=key, phi=phi, threshold=threshold):
        yield *state[:3], np.abs(state.response) < threshold, state.adaptation


def layers_sigmas_exchanged(lL, *, sigma_s, sigma_r=0.4):
    return layers(lL, sigma_s=sigma_r, sigma_r=sigma_s)


def layers_sigma_r_ignored(lL, *, sigma_s, sigma_r=0.4):
    return layers(lL, sigma_s=sigma_s, sigma_r=0.4)


def layers_of_natural_logarithms(lL, *, sigma_s, sigma_r=0.4):
    base = bilateral(np.log(10) * lL, sigma_s=sigma_s, sigma_r=sigma_r).mean / np.log(10)
    return base, lL - base


def layers_window_of_one_sigma(lL, *, sigma_s, sigma_r=0.4):
    r = round(sigma_s)
    H, W = lL.shape
    wide = np.pad(lL, r, mode="reflect")
    total = np.zeros(lL.shape)
    weight = np.zeros(lL.shape)
    for dy in range(2 * r + 1):
        for dx in range(2 * r + 1):
            q = wide[dy : dy + H, dx : dx + W]
            d2 = (dy - r) ** 2 + (dx - r) ** 2
            gw = np.exp(-d2 / (2 * sigma_s**2) - (q - lL) ** 2 / (2 * sigma_r**2))
            total += gw * q
            weight += gw
    base = total / weight
    return base, lL - base


def fix_uncertain_narrow_blur(mean, k, *, sigma_s):
    blurred = gaussian_filter(mean, 1)
    u = np.clip(np.log(k) / np.log(np.sqrt(2 * np.pi) * sigma_s), 0, 1)
    return u * mean + (1 - u) * blurred


def adjust_steps_start_left_out(h, db, D, *, tolerance=0.025):
    yield from list(adjust_steps(h, db, D, tolerance=tolerance))[1:]


def adjust_steps_of_h_alone(h, db, D, *, tolerance=0.025):
    for state in adjust_steps(h, db, D, tolerance=tolerance):
        yield (state.h,)


def adjust_steps_tolerance_ignored(h, db, D, *, tolerance=0.025):
    yield from adjust_steps(h, db, D)


def adjust_steps_never_gives_up(h, db, D, *, tolerance=0.025):
    state = (h, np.inf, h.sum(), np.inf)
    yield state
    for _ in range(500):
        T = state[0].sum()
        ceiling = T * db / D
        cut = np.maximum(state[0] - ceiling, 0).sum()
        state = (np.minimum(state[0], ceiling), ceiling, T, cut)
        yield state
        if cut < tolerance * T:
            return


def adjust_steps_scaled(h, db, D, *, tolerance=0.025):
    for state in adjust_steps(h, db, D, tolerance=tolerance):
        yield state.h / h.sum(), *state[1:]


def scale_negative(L, *, headroom=8.0, sigma):
    return -scale(L, headroom=headroom, sigma=sigma)


def scale_one_number(L, *, headroom=8.0, sigma):
    return 1 / (headroom * L.mean())


def scale_headroom_of_8(L, *, headroom=8.0, sigma):
    return scale(L, sigma=sigma)


def scale_sigma_doubled(L, *, headroom=8.0, sigma):
    return scale(L, headroom=headroom, sigma=2 * sigma)


def attenuation_steps_finest_first(lL, **parameters):
    yield from reversed(list(attenuation_steps(lL, **parameters)))


def attenuation_steps_one_level_fewer(lL, **parameters):
    yield from list(attenuation_steps(lL, **parameters))[1:]


def attenuation_steps_noise_ignored(lL, **parameters):
    yield from attenuation_steps(lL, **{**parameters, "noise": 1e-9})


def attenuation_steps_enlarged_by_repeating(lL, **parameters):
    Phi = np.ones((1, 1))
    for k, level, slope, phi, _ in attenuation_steps(lL, **parameters):
        repeated = np.kron(Phi, np.ones((2, 2)))
        short = np.maximum(np.array(phi.shape) - repeated.shape, 0)
        wide = np.pad(repeated, [(0, n) for n in short], mode="edge")
        Phi = wide[: phi.shape[0], : phi.shape[1]] * phi
        yield k, level, slope, phi, Phi


def divergence_of_two_parts(G):
    return np.stack([divergence(G * [[[1]], [[0]]]), divergence(G * [[[0]], [[1]]])])


def divergence_keeps_the_last_row(G):
    wide = np.pad(G[1, :, :-1], ((0, 0), (1, 1)))
    return np.diff(G[0], axis=0, prepend=0) + np.diff(wide, axis=1)


def divergence_keeps_the_last_column(G):
    wide = np.pad(G[0, :-1], ((1, 1), (0, 0)))
    return np.diff(wide, axis=0) + np.diff(G[1], axis=1, prepend=0)


def solve_0_over_0(divG):
    u = solve(divG)
    return u if divG.any() else u * np.nan
