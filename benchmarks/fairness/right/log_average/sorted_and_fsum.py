"""Plain Python: a sorted list for the median, math.fsum for the mean; NaN where all is black."""

import math


def median(values):
    values = sorted(values)
    n = len(values)
    return values[n // 2] if n % 2 else (values[n // 2 - 1] + values[n // 2]) / 2


def log_average(L, *, delta=1e-06):
    values = [float(v) for row in L for v in row]
    lit = [v for v in values if v != 0]
    if not lit:
        return math.nan
    d = delta * median(lit)
    if d == 0 and len(lit) < len(values):
        return 0.0
    return math.exp(math.fsum(math.log(d + v) for v in values) / len(values))
