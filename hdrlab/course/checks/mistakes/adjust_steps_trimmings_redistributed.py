"""You put the trimmings back into other bins: that raises their slopes above 1. What is cut off is gone."""

import numpy as np

from hdrlab.tonemap import ward


def adjust_steps(h, db, D, *, tolerance=0.025):
    yield h, float("inf"), h.sum(), 0.0
    for _ in range(40):
        cut = ward.trim(h, db, D)
        room = cut.h < cut.ceiling
        h = cut.h + np.where(room, cut.trimmings / max(room.sum(), 1), 0)
        yield h, cut.ceiling, cut.T, cut.trimmings
        if cut.trimmings < tolerance * cut.T:
            return
