"""A table of the codes in the middle of each bin, without interpolation, in float32."""

import numpy as np


def equalise(L, *, bins=1024, limit=4.0):
    ordered = np.sort(L, axis=None)
    a, b = np.log(ordered[1]), np.log(ordered[-2])
    missing = np.log(2) - (b - a)
    if missing > 0:
        a, b = a - missing / 2, b + missing / 2
    k = np.clip(np.floor((np.log(L) - a) / (b - a) * bins), 0, bins - 1).astype(int)
    h = np.bincount(k.ravel(), minlength=bins) / k.size
    top = limit / bins
    excess = np.sum(np.maximum(h - top, 0))
    room = np.maximum(top - h, 0)
    h = np.minimum(h, top) + (excess * room / room.sum() if room.any() else 0)
    code = np.cumsum(h) - h / 2
    light = np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)
    return light.astype(np.float32)[k]
