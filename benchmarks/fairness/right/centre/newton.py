"""Softmax of -b d^2: Newton steps for b, whose derivative is a covariance, kept between bounds by halving."""

import numpy as np


def centre(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    """Return w (H, W), a Gaussian about `at` whose sum is 1: `inside` of it lies on the pixels of a spot."""
    H, W = shape
    y, x = np.mgrid[:H, :W] + 0.5
    distance = np.hypot(y - at[0] * H, x - at[1] * W).ravel()
    count = min(max(round(share * (H * W)), 1), H * W)
    order = np.lexsort((np.arange(H * W), distance))
    disc = np.isin(np.arange(H * W), order[:count])
    d2 = ((y / H - at[0]) ** 2 + (x / W - at[1]) ** 2).ravel()

    def softmax(b):
        z = -b * d2
        w = np.exp(z - z.max())
        return w / w.sum()

    low, high, b = 0.0, np.inf, 1.0
    for _ in range(300):
        w = softmax(b)
        part = w[disc].sum()
        if part < inside:
            low = b
        else:
            high = b
        slope = part * (w @ d2) - w[disc] @ d2[disc]
        new = b + (inside - part) / slope if slope > 0 else np.nan
        if not low < new < min(high, 1e13):
            new = (low + high) / 2 if np.isfinite(high) else min(4 * b, 1e13)
        if abs(new - b) <= 1e-15 * b:
            break
        b = new
    return softmax(b).reshape(H, W)
