"""The line by hand, where a NaN on either side makes the next value NaN; a list as the answer."""

import math


def descend(T, start, *, low=12.0):
    series = [float(start)]
    while True:
        m = series[-1]
        i = math.floor(m)
        if not 0 <= m <= 255:
            return series
        part = m - i
        after = float(T[i]) if part == 0 else (1 - part) * float(T[i]) + part * float(T[i + 1])
        if math.isnan(after) or after < low or m - after < 0.5:
            return series
        series.append(after)
