"""A wrong exclusion: bytes wrap."""

import numpy as np

TASK = "exclusion"
MISCONCEPTION = (
    "Y is of one byte: where Y is less than t, Y - t wraps around to a large number. Turn Y into int first."
)


def exclusion(Y, t):
    return np.abs(Y - np.uint8(t)) > 4
