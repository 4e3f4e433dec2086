"""By the light that is gathered."""

import numpy as np


def equivalent_time(T, F, F_new, *, S=100, S_new=100):
    gathered = np.asarray(T, float) * S / np.square(F)
    return gathered * np.square(F_new) / S_new
