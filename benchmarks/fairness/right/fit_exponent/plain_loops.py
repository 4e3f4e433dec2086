"""Plain Python, in logarithms to base 2, whose factor cancels."""

from math import log2


def fit_exponent(ladders, *, alpha=0.0):
    top = bottom = 0.0
    for series, R in ladders:
        xs = [k * log2(float(R)) for k in range(len(series))]
        ys = [log2(float(m) - alpha) for m in series]
        mx, my = sum(xs) / len(xs), sum(ys) / len(ys)
        top += sum((x - mx) * (y - my) for x, y in zip(xs, ys))
        bottom += sum((x - mx) ** 2 for x in xs)
    return top / bottom
