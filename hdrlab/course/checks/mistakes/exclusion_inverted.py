"""A wrong exclusion: inverted."""

import numpy as np

TASK = "exclusion"
MISCONCEPTION = (
    "Your exclusion bitmap is inverted: it keeps just those pixels near the threshold that noise decides."
)


def exclusion(Y, t):
    return np.abs(Y.astype(int) - t) <= 4
