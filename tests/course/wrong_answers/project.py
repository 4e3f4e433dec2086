"""Wrong answers to the task of the project. Each one breaks one sentence of its assignment, and no other.

A function's name begins with the id of its task.
"""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.tonemap.reinhard import WIDTHS, display, scale_steps, scale_to_key, tonemap


def tonemap_white_is_the_maximum(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    if white is None:
        white = max(float(scale_to_key(L, key=key).max()), 1.0)
    return tonemap(L, key=key, white=white, local=local, phi=phi, threshold=threshold)


def tonemap_white_below_1(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    if white is None:
        white = max(float(np.quantile(scale_to_key(L, key=key), 0.9999)), 1e-6)
    return tonemap(L, key=key, white=white, local=local, phi=phi, threshold=threshold)


def tonemap_always_global(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    return tonemap(L, key=key, white=white)


def tonemap_default_phi(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    return tonemap(L, key=key, white=white, local=local)


def tonemap_default_key(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    return tonemap(L, white=white, local=local, phi=phi, threshold=threshold)


def tonemap_absolute_delta(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    Lm = key * L / np.exp(np.mean(np.log(L + 1e-6)))
    if white is None:
        white = max(float(np.quantile(Lm, 0.9999)), 1.0)
    return np.float32(display(Lm, Lm, white))


def tonemap_sigma_is_s(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    if not local:
        return tonemap(L, key=key, white=white)
    Lm = scale_to_key(L, key=key)
    blurred = [gaussian_filter(Lm, s) for s in WIDTHS]
    *_, last = scale_steps(blurred, key=key, phi=phi, threshold=threshold)
    return display(Lm, last.adaptation, np.inf if white is None else white)


def tonemap_dithered(L, **parameters):
    Ld = tonemap(L, **parameters)
    return np.clip(Ld + np.random.default_rng().uniform(-0.004, 0.004, Ld.shape), 0, 1)


def tonemap_hardly_visible(L, **parameters):
    return tonemap(L, **parameters) * np.float32(0.005)
