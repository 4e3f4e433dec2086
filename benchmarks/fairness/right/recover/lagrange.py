"""f(1) = 1 by Lagrange's multiplier."""

import numpy as np


def recover(images, times, *, order=5, eps=1e-3):
    by_time = np.argsort(times)
    t, M = np.asarray(times, float)[by_time], np.asarray(images)[by_time] / 255.0
    channels = M.reshape(*M.shape[:3], -1)[:, ::2, ::2]
    channels = channels.reshape(len(t), -1, channels.shape[-1]).transpose(2, 0, 1)
    g = np.stack([curve(own, t, order, eps) for own in channels], axis=-1)
    return g[:, 0] if M.ndim == 3 else g


def curve(M, t, order, eps):
    R, k, before, z = t[:-1] / t[1:], np.arange(1, order + 1), np.inf, np.arange(256) / 255
    seen = (M > 0.05) & (M < 0.98)
    pairs = [
        (M[q, both], M[q + 1, both]) for q in range(len(t) - 1) for both in [seen[q] & seen[q + 1]]
    ]
    for _ in range(100):
        A = np.concatenate(
            [a[:, None] ** k - r * b[:, None] ** k for (a, b), r in zip(pairs, R, strict=True)]
        )
        H = A.T @ A
        c = np.linalg.solve(
            np.block([[H, np.ones((len(k), 1))], [np.ones((1, len(k))), np.zeros((1, 1))]]),
            np.append(np.zeros(len(k)), 1),
        )[:-1]
        f = z[:, None] ** k @ c
        R = [(a[:, None] ** k @ c).sum() / (b[:, None] ** k @ c).sum() for a, b in pairs]
        if np.max(np.abs(f - before)) < eps:
            break
        before = f
    steps = np.maximum(np.diff(f), 1e-6)
    f = np.cumsum(np.append(steps[0] / 2, steps))
    return np.log(f / f[128])
