"""Inverse variances t^2 / variance with weights in float32, float64 only at the end, four rounds after X."""

import numpy as np


def inverse_variance_merge(X, D, measured, t, N, R):
    f = np.float32
    t = np.asarray(t, f)[:, None, None]
    X, D = np.where(measured, X, 1).astype(f), np.where(measured, D, 1).astype(f)
    light = X
    for _ in range(5):
        V = light / f(N) + f((R / N) ** 2) + D * D / f(12)
        w = np.where(measured, t * t / V, f(0))
        W = w.sum(0)
        with np.errstate(divide="ignore", invalid="ignore"):
            E = np.einsum("phw,phw->hw", w, X / t) / W
        light = E * t
    with np.errstate(divide="ignore"):
        return E.astype(float), 1 / np.sqrt(W.astype(float))
