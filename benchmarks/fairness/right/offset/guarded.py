"""Black and white first, then math."""

import math


def offset(average, target=128.0, a=1.79, c=0.192):
    if average <= 0:
        return 8.0
    if average >= 255:
        return -8.0

    def q(Y):
        return -math.log((255.0 / Y) ** (1 / c) - 1) / a

    return max(-8.0, min(8.0, q(target) - q(average)))
