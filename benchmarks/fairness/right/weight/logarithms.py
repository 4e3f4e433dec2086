"""The sum of the measures' logarithms, each times its power; a measure of power 0 is left out."""

import numpy as np


def weight(F, powers=(1, 1, 1)):
    R, G, B = F.astype(float)
    Y = np.pad(0.299 * R + 0.587 * G + 0.114 * B, 1, mode="symmetric")
    detail = np.abs(Y[:-2, 1:-1] + Y[2:, 1:-1] + Y[1:-1, :-2] + Y[1:-1, 2:] - 4 * Y[1:-1, 1:-1])
    colour = np.sqrt((R**2 + G**2 + B**2) / 3 - ((R + G + B) / 3) ** 2)
    light = sum((0.5 - v) ** 2 for v in (R, G, B)) / (-2 * 0.2**2)
    total = powers[2] * light
    for measure, power in ((detail, powers[0]), (colour, powers[1])):
        if power:
            total = total + power * np.log(np.maximum(measure, 1e-12))
    return np.exp(total)
