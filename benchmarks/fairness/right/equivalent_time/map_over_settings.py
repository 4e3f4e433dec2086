"""Plain Python for one setting, np.vectorize for arrays only; keywords become positions."""

import numpy as np


def _time(T, F, F_new, S, S_new):
    ratio = float(F_new) / float(F)
    return float(T) * ratio * ratio * float(S) / float(S_new)


def equivalent_time(T, F, F_new, *, S=100, S_new=100):
    arguments = (T, F, F_new, S, S_new)
    if all(np.isscalar(a) for a in arguments):
        return _time(*arguments)
    return np.vectorize(_time, otypes=[float])(*arguments)
