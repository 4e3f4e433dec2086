"""Known mistakes in `reconstruct`, the task of hdrlab.beyond.assorted.reconstruct."""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.beyond.assorted import CLIPPING_LEVEL
from hdrlab.course.checks.mistakes import mistake


@mistake(
    "reconstruct_full_pixels_count",
    says="You count full pixels, which makes bright places too dark. Their weight is 0.",
)
def full_pixels_count(Z, e, c=None, *, sigma=0.5, full_well=np.inf, read_noise=0.0):
    X = Z / 255
    w = e**2 / (X / full_well + (read_noise / full_well) ** 2 + 1 / (12 * 255**2))

    def fill(w):
        return gaussian_filter(w * X / e, sigma) / np.maximum(gaussian_filter(w, sigma), 1e-300)

    if c is None:
        return fill(w)
    return np.stack([fill(w * (c == k)) for k in range(3)], axis=-1)


@mistake(
    "reconstruct_all_weights_equal",
    says="You give all pixels that are not full the same weight. Behind a dark filter, X / e has "
    "a large error: the weight is e^2 over the variance of X.",
)
def all_weights_equal(Z, e, c=None, *, sigma=0.5, full_well=np.inf, read_noise=0.0):
    X = Z / 255
    w = np.where(X < CLIPPING_LEVEL, 1.0, 0.0)

    def fill(w):
        return gaussian_filter(w * X / e, sigma) / np.maximum(gaussian_filter(w, sigma), 1e-300)

    if c is None:
        return fill(w)
    return np.stack([fill(w * (c == k)) for k in range(3)], axis=-1)


@mistake(
    "reconstruct_e_not_squared",
    says="Your weight has the factor e. The variance of X / e is that of X over e^2, so the weight "
    "has e^2.",
)
def e_not_squared(Z, e, c=None, *, sigma=0.5, full_well=np.inf, read_noise=0.0):
    X = Z / 255
    noise = X / full_well + (read_noise / full_well) ** 2 + 1 / (12 * 255**2)
    w = np.where(X < CLIPPING_LEVEL, e / noise, 0)

    def fill(w):
        return gaussian_filter(w * X / e, sigma) / np.maximum(gaussian_filter(w, sigma), 1e-300)

    if c is None:
        return fill(w)
    return np.stack([fill(w * (c == k)) for k in range(3)], axis=-1)


@mistake(
    "reconstruct_sensor_noise_left_out",
    says="Your weights know only the noise of rounding. Add that of the photons, X / full_well, and "
    "that of reading.",
)
def sensor_noise_left_out(Z, e, c=None, *, sigma=0.5, full_well=np.inf, read_noise=0.0):
    X = Z / 255
    w = np.where(X < CLIPPING_LEVEL, e**2, 0)

    def fill(w):
        return gaussian_filter(w * X / e, sigma) / np.maximum(gaussian_filter(w, sigma), 1e-300)

    if c is None:
        return fill(w)
    return np.stack([fill(w * (c == k)) for k in range(3)], axis=-1)


@mistake(
    "reconstruct_not_divided_by_e",
    says="You average the pixel values themselves. A filter lets only a part of the light "
    "through: divide by e.",
)
def not_divided_by_e(Z, e, c=None, *, sigma=0.5, full_well=np.inf, read_noise=0.0):
    X = Z / 255
    noise = X / full_well + (read_noise / full_well) ** 2 + 1 / (12 * 255**2)
    w = np.where(X < CLIPPING_LEVEL, e**2 / noise, 0)

    def fill(w):
        return gaussian_filter(w * X, sigma) / np.maximum(gaussian_filter(w, sigma), 1e-300)

    if c is None:
        return fill(w)
    return np.stack([fill(w * (c == k)) for k in range(3)], axis=-1)
