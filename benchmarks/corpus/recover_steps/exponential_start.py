import numpy as np


def recover_steps(Z, times, w, *, tolerance=1e-4, max_iterations=200):
    t = np.asarray(times, float)
    n = len(w)
    g = np.exp(np.arange(n) / 128) / np.exp(1)
    states = [(g.copy(),)]
    for it in range(max_iterations):
        with np.errstate(all="ignore"):
            E = (w[Z] * g[Z] * t).sum(axis=1) / (w[Z] * t**2).sum(axis=1)
        ok = ~np.isnan(E)
        new = np.zeros(n)
        empty = np.zeros(n, bool)
        for m in range(n):
            i, j = np.where(Z[ok] == m)
            if len(i) == 0:
                empty[m] = True
            else:
                new[m] = np.sum(E[ok][i] * t[j]) / len(i)
        new[empty] = np.interp(np.flatnonzero(empty), np.flatnonzero(~empty), new[~empty])
        new = new / new[128]
        states.append((new,))
        if np.max(np.abs(new - g)) < tolerance:
            break
        g = new
    return states
