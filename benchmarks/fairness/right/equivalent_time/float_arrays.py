"""Everything becomes float64 arrays first, so lists and small integers work too."""

import numpy as np


def equivalent_time(T, F, F_new, *, S=100, S_new=100):
    T, F, F_new, S, S_new = [np.asarray(x, dtype=np.float64) for x in (T, F, F_new, S, S_new)]
    ratio = np.square(F_new / F)
    return T * ratio * (S / S_new)
