"""Pixel by pixel; lists."""

import numpy as np


def is_skin(R, G, B):
    s = R + G + B
    if s <= 0:
        return False
    r, g = R / s, G / s
    if not -0.776 * r * r + 0.5601 * r + 0.1766 < g < -1.3767 * r * r + 1.0743 * r + 0.1452:
        return False
    return r > g and (r - 1 / 3) ** 2 + (g - 1 / 3) ** 2 > 0.0004


def find_by_locus(Z):
    values = [is_skin(*map(float, pixel)) for pixel in Z.reshape(-1, 3)]
    return np.array(values).reshape(Z.shape[:-1]).tolist()
