"""Works out the exposure T S / F^2 and solves it for the new time; Python float for numbers."""

import numpy as np


def _light(T, F, S):
    return T * S / F**2


def equivalent_time(T, F, F_new, *, S=100, S_new=100):
    before = _light(np.asarray(T, float), np.asarray(F, float), np.asarray(S, float))
    per_second = _light(1.0, np.asarray(F_new, float), np.asarray(S_new, float))
    seconds = before / per_second
    return seconds.item() if np.ndim(seconds) == 0 else seconds
