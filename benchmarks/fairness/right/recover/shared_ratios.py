"""All channels share the ratios, since they share the shutter; basis M^k - M needs no side condition."""

import numpy as np
from scipy import linalg


def recover(images, times, *, order=5, eps=0.001):
    images = np.asarray(images)
    times = np.asarray(times, dtype=float).ravel()
    gray = images.ndim == 3
    if gray:
        images = images[..., np.newaxis]
    if images.ndim != 4 or images.shape[0] != times.size:
        raise ValueError("one time per photograph, please")
    full = 65535 if images.dtype == np.uint16 else 255
    ranks = np.argsort(times, kind="stable")
    channels = range(images.shape[3])

    ratio, samples = {}, {}
    for q, (first, second) in enumerate(zip(ranks[:-1], ranks[1:])):
        if times[first] == times[second]:
            continue
        for c in channels:
            a, b = images[first, ..., c].ravel() / full, images[second, ..., c].ravel() / full
            both = (np.minimum(a, b) > 0.05) & (np.maximum(a, b) < 0.98)
            if np.count_nonzero(both) > order:
                samples[q, c] = a[both], b[both]
                ratio[q] = times[first] / times[second]
    if not all(any((q, c) in samples for q in ratio) for c in channels) or not ratio:
        raise ValueError("the photographs share no levels worth using")

    def basis(M):
        return (
            np.stack([M**k - M for k in range(2, order + 1)], axis=-1)
            if order > 1
            else np.zeros((len(M), 0))
        )

    ready = {key: (a, b, basis(a), basis(b)) for key, (a, b) in samples.items()}
    M = np.arange(256) / 255
    curves = None
    for _ in range(60):
        coefficients = []
        for c in channels:
            mine = [(ratio[q], ready[q, c]) for q in ratio if (q, c) in ready]
            A = np.concatenate([Pa - R * Pb for R, (a, b, Pa, Pb) in mine])
            right = np.concatenate([R * b - a for R, (a, b, Pa, Pb) in mine])
            coefficients.append(linalg.lstsq(A, right)[0] if order > 1 else np.zeros(0))
        new = np.stack([M + basis(M) @ x for x in coefficients], axis=1)
        if curves is not None and np.abs(new - curves).max() < eps:
            curves = new
            break
        curves = new
        for q in ratio:
            above = sum(
                (ready[q, c][0] + ready[q, c][2] @ coefficients[c]).sum()
                for c in channels
                if (q, c) in ready
            )
            below = sum(
                (ready[q, c][1] + ready[q, c][3] @ coefficients[c]).sum()
                for c in channels
                if (q, c) in ready
            )
            ratio[q] = above / below

    # no light is level 0; below the first level from which the curve rises, a line to the origin
    for f in curves.T:
        falls = [z for z in range(1, 128) if not (0 < f[z] < f[z + 1])]
        start = falls[-1] + 1 if falls else 1
        f[:start] = f[start] * np.arange(start) / start
        f[1:] = np.maximum.accumulate(f[1:])
        f[1:] *= 1 + 1e-12 * np.arange(255)
    with np.errstate(divide="ignore"):
        g = np.log(curves)
    g = g - g[128]
    return g[:, 0] if gray else g
