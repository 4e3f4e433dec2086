"""A loop over the channels of a colour picture, with the range of each."""

import numpy as np


def gain_map(sdr, hdr, low, high, *, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    sdr, hdr = np.asarray(sdr, float), np.asarray(hdr, float)
    count = sdr.shape[-1]
    low, high = (
        np.full(count, low) if np.ndim(low) == 0 else low,
        np.full(count, high) if np.ndim(high) == 0 else high,
    )
    planes = []
    for c in range(count):
        G = np.log((hdr[..., c] + k[1]) / (sdr[..., c] + k[0])) / np.log(2)
        planes.append(np.clip((G - low[c]) / (high[c] - low[c]), 0, 1) ** gamma)
    return np.stack(planes, axis=-1)
