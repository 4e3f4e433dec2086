"""f is inverted by halving an interval."""

import math


def offset(average, target=128.0, *, a=1.79, c=0.192):
    def f(q):
        return 255 / (1 + math.exp(-a * q)) ** c

    def inverse(Y):
        low, high = -60.0, 60.0
        for _ in range(80):
            middle = (low + high) / 2
            low, high = (middle, high) if f(middle) < Y else (low, middle)
        return low

    return min(max(inverse(target) - inverse(average), -8.0), 8.0)
