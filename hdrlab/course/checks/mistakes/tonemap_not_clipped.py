"""Your picture leaves 0 ... 1: a display cannot show that, and files wrap around. Clip it."""

import numpy as np

from hdrlab.tonemap import reinhard


def tonemap(L, **knobs):
    return np.asarray(reinhard.tonemap(L, **knobs), float) * 1.5
