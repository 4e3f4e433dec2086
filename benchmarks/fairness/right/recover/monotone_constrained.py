"""Distinct level pairs with their numbers; a fit that would fall is redone by SLSQP with a slope above 0."""

import numpy as np
from scipy import optimize


def _pairs(dark, bright):
    both, number = np.unique(np.stack([dark.ravel(), bright.ravel()]), axis=1, return_counts=True)
    M = both / 255
    keep = ((M >= 0.05) & (M <= 0.98)).all(axis=0)
    return M[0, keep], M[1, keep], number[keep]


class _Polynomial:
    """f^-1 with c_1 .. c_K of sum 1."""

    def __init__(self, order):
        self.k = np.arange(1, order + 1)
        self.c = np.zeros(order)

    def __call__(self, M):
        return np.power.outer(M, self.k) @ self.c

    def fit(self, pairs, ratios):
        rows = [
            np.sqrt(n)[:, None] * (np.power.outer(a, self.k) - R * np.power.outer(b, self.k))
            for (a, b, n), R in zip(pairs, ratios)
        ]
        D = np.vstack(rows)
        Q = D.T @ D / sum(n.sum() for _, _, n in pairs)
        K = len(self.k)
        start = np.full(K, 1 / K)
        null = np.linalg.svd(np.ones((1, K)))[2][1:]
        if K > 1:
            move = np.linalg.lstsq(D @ null.T, -D @ start, rcond=None)[0]
            self.c = start + null.T @ move
        else:
            self.c = np.ones(1)
        slopes = self.k * np.power.outer(np.linspace(0, 1, 129), self.k - 1)
        if (slopes @ self.c).min() < 1e-4:
            scale = 1 / np.trace(Q)
            found = optimize.minimize(
                lambda c: 1e4 * scale * c @ Q @ c,
                np.eye(K)[0],
                jac=lambda c: 2e4 * scale * Q @ c,
                method="SLSQP",
                constraints=[
                    {"type": "eq", "fun": lambda c: c.sum() - 1, "jac": lambda c: np.ones(K)},
                    {"type": "ineq", "fun": lambda c: slopes @ c - 1e-4, "jac": lambda c: slopes},
                ],
                options={"maxiter": 300, "ftol": 1e-12},
            )
            self.c = found.x


def _recover_one(images, times, order, eps):
    pairs, ratios = [], []
    for q in range(len(times) - 1):
        a, b, n = _pairs(images[q], images[q + 1])
        if n.sum() and times[q] != times[q + 1]:
            pairs.append((a, b, n))
            ratios.append(times[q] / times[q + 1])
    if not pairs:
        raise ValueError("the photographs share no levels worth using")
    f, levels, values = _Polynomial(order), np.arange(256) / 255, None
    for _ in range(50):
        f.fit(pairs, ratios)
        old, values = values, f(levels)
        if old is not None and np.abs(values - old).max() < eps:
            break
        ratios = [float(n @ f(a)) / float(n @ f(b)) for a, b, n in pairs]
    values = np.maximum.accumulate(np.maximum(values, 1e-7 * levels)) + 1e-12 * np.arange(256)
    with np.errstate(divide="ignore"):
        g = np.log(values)
    return g - g[128]


def recover(images, times, *, order=5, eps=0.001):
    images = np.asarray(images)
    times = np.asarray(times, dtype=float)
    if images.ndim not in (3, 4) or times.ndim != 1 or len(images) != len(times):
        raise ValueError("images (P, H, W[, 3]) and times (P,) do not fit together")
    if images.dtype.itemsize > 1:
        images = (images.astype(np.uint32) * 255 + 32767) // 65535
    by_time = np.argsort(times, kind="stable")
    if images.ndim == 3:
        return _recover_one(images[by_time], times[by_time], order, eps)
    return np.stack(
        [
            _recover_one(channel[by_time], times[by_time], order, eps)
            for channel in np.moveaxis(images, -1, 0)
        ],
        axis=-1,
    )
