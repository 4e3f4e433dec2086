"""Channel by channel, tables of w and w g looked up by np.take; without weights the frames' plain mean."""

import numpy as np


def merge_channel(Z, ln_t, g, w):
    total = np.take(w, Z).sum(axis=0)
    upper = np.take(w * g, Z).sum(axis=0) - np.einsum("p...,p->...", np.take(w, Z), ln_t)
    plain = np.mean([g[z] - b for z, b in zip(Z, ln_t)], axis=0)
    return np.where(total > 0, upper / np.where(total > 0, total, 1), plain)


def merge(images, times, g, w=None):
    Z = np.asarray(images).astype(int)
    ln_t = np.log(np.asarray(times, float))
    g = np.asarray(g, float)
    if w is None:
        w = np.concatenate([np.arange(128), np.arange(128)[::-1]])
    w = np.asarray(w, float)
    if Z.ndim == 3:
        return np.exp(merge_channel(Z, ln_t, g.reshape(256, -1)[:, 0], w))
    if g.ndim == 1:
        g = np.repeat(g[:, None], Z.shape[-1], axis=1)
    return np.exp(
        np.stack([merge_channel(Z[..., c], ln_t, g[:, c], w) for c in range(Z.shape[-1])], -1)
    )
