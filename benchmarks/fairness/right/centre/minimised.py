"""The width that makes the difference smallest, in float32 at last."""

import numpy as np
from scipy.optimize import minimize_scalar


def centre(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    y, x = (np.indices(shape).reshape(2, -1).T + 0.5).T
    d2 = (y / shape[0] - at[0]) ** 2 + (x / shape[1] - at[1]) ** 2
    pixels = (y - at[0] * shape[0]) ** 2 + (x - at[1] * shape[1]) ** 2
    rank = np.argsort(np.argsort(pixels))
    core = rank < round(share * pixels.size)

    def off(log_sigma):
        w = np.exp(-d2 / (2 * np.exp(2 * log_sigma)))
        return (w[core].sum() / w.sum() - inside) ** 2

    best = minimize_scalar(
        off, bounds=(np.log(0.05), np.log(3)), method="bounded", options={"xatol": 1e-8}
    )
    w = np.exp(-d2 / (2 * np.exp(2 * best.x)))
    return (w / w.sum()).reshape(shape).astype(np.float32)
