"""Each trim calls the next one (yield from), at most some hundred times."""

import numpy as np


def trims(h, share, tolerance, first, depth):
    T = np.sum(h)
    ceiling = share * T
    cut = np.clip(h, None, ceiling)
    trimmings = np.sum(h - cut)
    yield cut, ceiling, T, trimmings
    enough = trimmings < tolerance * T or np.sum(cut) <= tolerance * first
    if not enough and trimmings > 0 and depth < 400:
        yield from trims(cut, share, tolerance, first, depth + 1)


def adjust_steps(h, db, D, *, tolerance=0.025):
    h = np.asarray(h) * 1.0
    yield h, np.inf, np.sum(h), np.inf
    yield from trims(h, db / D, tolerance, np.sum(h), 1)
