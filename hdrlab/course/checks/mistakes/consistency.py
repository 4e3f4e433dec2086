"""Known mistakes in `consistency`, the task of hdrlab.beyond.video.consistency."""

import numpy as np

from hdrlab.beyond.video import VALUE_TOLERANCE
from hdrlab.course.checks.mistakes import mistake


def difference(v, v_):
    return np.abs(v - v_).max(axis=-1, keepdims=True) / VALUE_TOLERANCE


@mistake(
    "consistency_not_limited",
    says="Your weight rises again beyond d = 1. Limit d to 1.",
)
def not_limited(v, v_):
    d = difference(v, v_)
    return (2 * d - 3) * d * d + 1


@mistake(
    "consistency_mean_of_the_channels",
    says="You take the mean over the channels. The channel that differs most decides: take the "
    "maximum.",
)
def mean_of_the_channels(v, v_):
    d = np.minimum(np.abs(v - v_).mean(axis=-1, keepdims=True) / VALUE_TOLERANCE, 1)
    return (2 * d - 3) * d * d + 1


@mistake(
    "consistency_straight_line",
    says="Your weight falls along a straight line, 1 - d. Use 2 d^3 - 3 d^2 + 1, which begins and "
    "ends flat.",
)
def straight_line(v, v_):
    return 1 - np.minimum(difference(v, v_), 1)


@mistake(
    "consistency_with_sign",
    says="You forgot the absolute value, so darker neighbors always agree.",
)
def with_sign(v, v_):
    d = np.clip((v - v_).max(axis=-1, keepdims=True) / VALUE_TOLERANCE, 0, 1)
    return (2 * d - 3) * d * d + 1
