"""The mean of both sensors."""

import numpy as np


def join_sensors(B, D, full):
    return (B + D) / 2, np.ones(B.shape)
