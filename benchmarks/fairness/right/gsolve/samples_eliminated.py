"""Projects every sample's ln E out of its rows, solves for g alone, and then takes weighted means."""

from typing import NamedTuple

import numpy as np


class Solution(NamedTuple):
    """The curve, and each sample's ln irradiance, 0 for a sample without weight."""

    g: np.ndarray
    lE: np.ndarray


def _two_exposures(valid, B):
    return any(np.unique(B[row]).size > 1 for row in valid)


def gsolve(Z, B, smoothness, w):
    Z = np.asarray(Z)
    B = np.asarray(B, dtype=float)
    w = np.asarray(w, dtype=float)
    if Z.ndim != 2 or B.shape != (Z.shape[1],) or w.ndim != 1:
        raise ValueError("the arrays do not fit together")
    if ((Z < 0) | (Z >= len(w))).any():
        raise ValueError("a level has no weight in w")
    n = len(w)
    W = w[Z]
    if not _two_exposures(W > 0, B):
        raise ValueError("no sample is seen well in two different exposures")

    rows, right = [], []
    eye = np.eye(n)
    for z, wi in zip(Z, W):
        length = np.sqrt(wi @ wi)
        if length == 0:
            continue
        direction = wi / length
        block = wi[:, None] * eye[z]
        values = wi * B
        rows.append(block - np.outer(direction, direction @ block))
        right.append(values - direction * (direction @ values))
    second = np.diff(eye, n=2, axis=0) * (smoothness * w[1:-1, None])
    rows += [second, eye[n // 2][None, :]]
    right += [np.zeros(n - 2), np.zeros(1)]
    g = np.linalg.lstsq(np.vstack(rows), np.concatenate(right), rcond=None)[0]

    used = np.zeros(n, dtype=bool)
    used[Z[W > 0]] = True
    used |= (second != 0).any(axis=0)
    used[n // 2] = True
    known = np.flatnonzero(used)
    lE = np.zeros(len(Z))
    total = (W**2).sum(axis=1)
    seen = total > 0
    lE[seen] = (W**2 * (g[Z] - B)).sum(axis=1)[seen] / total[seen]
    for z in np.flatnonzero(~used):
        distance = np.abs(known - z)
        g[z] = g[known[distance == distance.min()]].mean()
    return Solution(g=g, lE=lE)
