"""The display's range is a natural logarithm, like db; you took it for decades, and the ceiling is 2.3
times too high or too low."""

import numpy as np

from hdrlab.tonemap import ward


def adjust_steps(h, db, D, *, tolerance=0.025):
    return ward.adjust_steps(h, db, D / np.log(10), tolerance=tolerance)
