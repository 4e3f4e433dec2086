"""Counts the difference in stops and applies 2 to that power; what is not positive is a ValueError."""

import numpy as np


def equivalent_time(T, F, F_new, *, S=100, S_new=100):
    logs = []
    for value in (F, F_new, S, S_new):
        value = np.asarray(value, dtype=float)
        if (value <= 0).any():
            raise ValueError("f-numbers and ISO speeds must be positive")
        logs.append(np.log2(value))
    stops = 2 * (logs[1] - logs[0]) + logs[2] - logs[3]
    return np.asarray(T, dtype=float) * np.exp2(stops)
