import numpy as np


def log_average(L, *, delta=1e-6):
    Lw_bar = np.mean(np.log(L + delta))
    return Lw_bar
