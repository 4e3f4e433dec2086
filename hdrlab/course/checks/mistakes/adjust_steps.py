"""Known mistakes in `adjust_steps`, the task of hdrlab.tonemap.ward.adjust_steps."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.tonemap.ward import Trim, ceiling, trim


@mistake(
    "adjust_steps_trimmings_redistributed",
    says="You put the trimmings back into other bins, which makes the curve too steep there. "
    "Discard them.",
)
def trimmings_redistributed(h, db, D, *, tolerance=0.025):
    def trim(h, db, D):
        T = float(h.sum())
        top = ceiling(T, db, D)
        cut = float(np.maximum(h - top, 0).sum())
        room = h < top
        return Trim(np.minimum(h, top) + np.where(room, cut / max(room.sum(), 1), 0), top, T, cut)

    state = Trim(h, np.inf, float(h.sum()), np.inf)
    yield state
    for _ in range(40):
        state = trim(state.h, db, D)
        yield state
        if state.trimmings < tolerance * state.T:
            return


@mistake(
    "adjust_steps_decades",
    says="The display's range D is a natural logarithm, like db. You took it as decades, so "
    "the ceiling is wrong by a factor of 2.3.",
)
def decades(h, db, D, *, tolerance=0.025):
    def ceiling(T, db, D):
        return T * db * np.log(10) / D

    def trim(h, db, D):
        T = float(h.sum())
        top = ceiling(T, db, D)
        return Trim(np.minimum(h, top), top, T, float(np.maximum(h - top, 0).sum()))

    state = Trim(h, np.inf, float(h.sum()), np.inf)
    yield state
    while state.trimmings >= tolerance * state.T and state.h.sum() > tolerance * h.sum():
        state = trim(state.h, db, D)
        yield state


@mistake(
    "adjust_steps_once",
    says="You applied the ceiling once. A trim lowers T, and with it the ceiling. Trim again "
    "until hardly anything is cut off.",
    misses_method=True,
)
def once(h, db, D, *, tolerance=0.025):
    state = Trim(h, np.inf, float(h.sum()), np.inf)
    yield state
    if state.trimmings >= tolerance * state.T and state.h.sum() > tolerance * h.sum():
        state = trim(state.h, db, D)
        yield state
