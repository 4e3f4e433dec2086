"""Value by value, black and white by hand, in a list."""

import math


def table(delta, *, a=1.79, c=0.192):
    values = [0]
    for Y in range(1, 255):
        q = -math.log((255 / Y) ** (1 / c) - 1) / a
        values.append(round(255 / (1 + math.exp(-a * (q + delta))) ** c))
    return values + [255]
