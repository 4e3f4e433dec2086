"""Builds a list with a tuple class of its own; trimmings as the difference of two sums."""

import numpy as np


class Trim(tuple):
    """The sheet's four values, with their names, without typing.NamedTuple."""

    h = property(lambda self: self[0])
    ceiling = property(lambda self: self[1])
    T = property(lambda self: self[2])
    trimmings = property(lambda self: self[3])


def adjust_steps(h, db, D, *, tolerance=0.025):
    h = np.asarray(h, dtype=np.float64)
    steps = [Trim((h, float("inf"), float(h.sum()), float("inf")))]
    done = False
    while not done:
        before = steps[-1].h
        T = float(before.sum())
        ceiling = T * db / D
        after = np.where(before > ceiling, ceiling, before)
        trimmings = T - float(after.sum())
        steps.append(Trim((after, ceiling, T, trimmings)))
        little_trimmed = trimmings < tolerance * T
        little_left = after.sum() <= tolerance * steps[0].T
        done = little_trimmed or little_left or np.array_equal(after, before)
    return steps
