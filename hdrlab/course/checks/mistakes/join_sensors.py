"""Known mistakes in `join_sensors`, the task of hdrlab.beyond.splitter.join_sensors."""

import numpy as np
from scipy.ndimage import uniform_filter

from hdrlab.beyond.splitter import join_sensors, predict_full
from hdrlab.course.checks.mistakes import mistake


def mixed(B, D, P, full, u):
    """Return E and the cases for a prediction P and a fraction u."""
    bright = np.where(full, P, B)
    E = np.where(u > 1e-9, np.where(u > 1 - 1e-9, D, (1 - u) * bright + u * D), B)
    return E, join_sensors(B, D, full)[1]


def fraction(full):
    return uniform_filter(full.astype(float), 5, mode="nearest")


@mistake(
    "join_sensors_switched",
    says="You switch from B to D where B is full, so a seam shows. Mix them: u is the fraction of "
    "full pixels around.",
    misses_method=True,
)
def switched(B, D, full):
    return np.where(full, D, B), join_sensors(B, D, full)[1]


@mistake(
    "join_sensors_full_values_mixed",
    says="In case 3 you mix the value of a full pixel, which is too low. Use the prediction P.",
)
def full_values_mixed(B, D, full):
    return mixed(B, D, B, full, fraction(full))


@mistake(
    "join_sensors_prediction_without_D",
    says="You predict a full pixel by the mean of B around it. Multiply D at the pixel by the "
    "quotient of the sums of B and D.",
)
def prediction_without_D(B, D, full):
    count = uniform_filter((~full).astype(float), 5, mode="nearest")
    b = uniform_filter(np.where(full, 0, B), 5, mode="nearest")
    return mixed(B, D, np.where(count > 0, b / np.maximum(count, 1e-9), D), full, fraction(full))


@mistake(
    "join_sensors_full_pixels_in_the_sums",
    says="Your sums of B and D contain full pixels. Sum over the pixels where B is not full.",
)
def full_pixels_in_the_sums(B, D, full):
    P = D * uniform_filter(B, 5, mode="nearest") / uniform_filter(D, 5, mode="nearest")
    return mixed(B, D, P, full, fraction(full))


@mistake(
    "join_sensors_fraction_reversed",
    says="You mix with u and 1 - u exchanged: the more pixels are full, the more must D count.",
)
def fraction_reversed(B, D, full):
    u = fraction(full)
    bright = np.where(full, predict_full(B, D, full), B)
    E = np.where(u > 1e-9, np.where(u > 1 - 1e-9, D, u * bright + (1 - u) * D), B)
    return E, join_sensors(B, D, full)[1]


@mistake(
    "join_sensors_window_of_3",
    says="Your windows have 3 x 3 pixels. Take 5 x 5.",
)
def window_of_3(B, D, full):
    u = uniform_filter(full.astype(float), 3, mode="nearest")
    b = uniform_filter(np.where(full, 0, B), 3, mode="nearest")
    d = uniform_filter(np.where(full, 0, D), 3, mode="nearest")
    P = np.where(d > 0, D * b / np.where(d > 0, d, 1), D)
    E, _ = mixed(B, D, P, full, u)
    some = u > 1e-9
    case = np.where(full, np.where(u > 1 - 1e-9, 4, 3), np.where(some, 2, 1))
    return E, case
