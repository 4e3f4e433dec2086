"""A loop over the pixels, and the inverse of 2 x 2 by hand."""

import math

import numpy as np


def distance(Z, skin):
    (m1, m2), ((s11, s12), (s21, s22)) = skin
    det = s11 * s22 - s12 * s21
    out = []
    for R, G, B in Z.reshape(-1, 3):
        Y = max(0.299 * R + 0.587 * G + 0.114 * B, 1)
        u = 128 * (-0.168736 * R - 0.331264 * G + 0.5 * B) / Y - m1
        v = 128 * (0.5 * R - 0.418688 * G - 0.081312 * B) / Y - m2
        out.append(math.sqrt((s22 * u * u - (s12 + s21) * u * v + s11 * v * v) / det))
    return np.array(out).reshape(Z.shape[:-1]).tolist()
