"""The answer is float32 (as pictures are), shape and at may be lists; geometric bisection in float64."""

import numpy as np


def centre(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    """Return w (H, W), a Gaussian about `at` whose sum is 1: `inside` of it lies on the pixels of a spot."""
    size = np.array(shape, dtype=int)
    middle = np.asarray(at, dtype=float)
    pixels = np.moveaxis(np.indices(tuple(size)), 0, -1) + 0.5
    apart = pixels - middle * size
    in_pixels = np.linalg.norm(apart, axis=-1)
    count = int(np.clip(np.floor(share * size.prod() + 0.5), 1, size.prod()))
    disc = np.zeros(size.prod(), dtype=bool)
    disc[np.argpartition(in_pixels.ravel(), count - 1)[:count]] = True
    disc = disc.reshape(tuple(size))
    d2 = ((apart / size) ** 2).sum(axis=-1)
    d2 -= d2.min()
    low, high = 1e-6, 1e4
    for _ in range(120):
        sigma = np.sqrt(low * high)
        w = np.exp(-d2 / (2 * sigma**2))
        if w[disc].sum() > inside * w.sum():
            low = sigma
        else:
            high = sigma
    return (w / w.sum()).astype(np.float32)
