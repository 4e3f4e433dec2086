"""The constants as decimals of seven digits."""

import numpy as np


def pq(FD):
    power = np.power(np.divide(FD, 10_000.0), 0.1593018)
    return np.power((0.8359375 + 18.8515625 * power) / (1.0 + 18.6875 * power), 78.84375)
