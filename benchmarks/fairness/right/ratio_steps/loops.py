"""Plain loops over the pairs."""

import math


def ratio_steps(found, *, limit=9.0, tolerance=1e-6, rounds=100):
    pairs = list(zip(*(one.tolist() for one in found), strict=True))
    inside = [True] * len(pairs)
    k = V = math.nan
    for turn in range(rounds + 1):
        before = k
        if turn:
            inside = [(v * (y - k * x)) ** 2 <= limit * V for x, y, v in pairs]
        top = bottom = 0.0
        for (x, y, v), counts in zip(pairs, inside, strict=True):
            if counts:
                top += v * v * x * y
                bottom += v * v * x * x
        k = top / bottom
        errors = [
            (v * (y - k * x)) ** 2
            for (x, y, v), counts in zip(pairs, inside, strict=True)
            if counts
        ]
        V = sum(errors) / len(errors)
        yield k, list(inside), V
        if abs(k - before) < tolerance:
            return
