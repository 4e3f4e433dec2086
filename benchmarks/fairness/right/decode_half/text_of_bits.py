"""Reads the bits as text."""

import numpy as np


def one(word):
    text = f"{int(word):016b}"
    s, e, m = int(text[0], 2), int(text[1:6], 2), int(text[6:], 2)
    if e == 31:
        return float("nan") if m else (-1) ** s * float("inf")
    if e == 0:
        return (-1) ** s * 2**-14 * m / 1024
    return (-1) ** s * 2 ** (e - 15) * (1 + m / 1024)


def decode_half(bits):
    return np.vectorize(one, otypes=[float])(bits)
