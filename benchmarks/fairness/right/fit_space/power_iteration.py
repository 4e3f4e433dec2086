"""One direction after the other, by power iteration and deflation."""

import numpy as np


def fit_space(curves, count):
    mean = curves.sum(axis=0) / len(curves)
    X = curves - mean
    H = []
    for _ in range(count):
        v = X[np.argmax((X**2).sum(axis=1))]
        for _ in range(3000):
            v = X.T @ (X @ v)
            v = v / np.sqrt(v @ v)
        H.append(v)
        X = X - np.outer(X @ v, v)
    H = np.array(H)
    return [mean, H, np.sqrt(np.mean(((curves - mean) @ H.T) ** 2, axis=0))]
