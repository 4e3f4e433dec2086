"""Cut, room, excess."""

import numpy as np


def clip_histogram(h, limit=4.0):
    top = limit / len(h)
    cut = np.minimum(h, top)
    room = top - cut
    excess = h.sum() - cut.sum()
    return cut + room * (excess / room.sum()) if excess > 0 else cut
