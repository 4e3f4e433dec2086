"""In stops, with histc by integer positions; lists."""

import numpy as np


def equalise(L, *, bins=1024, limit=4.0):
    stops = np.log2(L).astype(float)
    flat = np.sort(stops, axis=None)
    low, high = flat[1], flat[-2]
    if high - low < 1:
        middle = (high + low) / 2
        low, high = middle - 0.5, middle + 0.5
    position = np.clip((stops - low) * bins / (high - low), 0, bins)
    counts = [0] * bins
    for p in position.ravel():
        counts[min(int(p), bins - 1)] += 1
    h = np.array(counts) / L.size
    cut = np.minimum(h, limit / bins)
    room = limit / bins - cut
    filled = cut + (room * (1 - cut.sum()) / room.sum() if room.sum() > 1e-15 else 0)
    P = np.concatenate(([0.0], np.add.accumulate(filled)))
    whole = np.minimum(position.astype(int), bins - 1)
    code = P[whole] + (position - whole) * filled[whole]
    return np.where(code < 0.04045, code / 12.92, (0.947867 * (code + 0.055)) ** 2.4).tolist()
