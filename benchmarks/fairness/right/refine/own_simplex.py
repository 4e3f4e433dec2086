"""A simplex and an interpolation of its own."""

import numpy as np


def refine(X, start, *, reach=1.0):
    h, w = X.shape[1:]
    r = np.hypot(h, w) / 2
    rows, columns = np.meshgrid(np.arange(h), np.arange(w), indexing="ij")

    def look(y, x):
        i, j = np.floor(y).astype(int), np.floor(x).astype(int)
        inside = (i >= 0) & (j >= 0) & (i < h - 1) & (j < w - 1)
        i, j = np.clip(i, 0, h - 2), np.clip(j, 0, w - 2)
        f, g = y - i, x - j
        m = X[1].astype(float)
        top = (1 - g) * m[i, j] + g * m[i, j + 1]
        bottom = (1 - g) * m[i + 1, j] + g * m[i + 1, j + 1]
        return np.where(inside, (1 - f) * top + f * bottom, np.nan)

    def e(m):
        phi = m[2] / r
        y, x = rows - (h - 1) / 2 - m[0], columns - (w - 1) / 2 - m[1]
        b = look(
            np.cos(phi) * y - np.sin(phi) * x + (h - 1) / 2,
            np.sin(phi) * y + np.cos(phi) * x + (w - 1) / 2,
        )
        d = (X[0] - b) / (0.5 * X[0] + 0.5 * b)
        return np.mean(d[~np.isnan(d)] ** 2)

    simplex = [np.array(start, float)]
    for k in range(3):
        corner = simplex[0].copy()
        corner[k] += reach
        simplex.append(corner)
    values = [e(c) for c in simplex]
    for _ in range(120):
        order = np.argsort(values)
        simplex = [simplex[k] for k in order]
        values = [values[k] for k in order]
        if max(np.abs(c - simplex[0]).max() for c in simplex) < 5e-3:
            break
        middle = sum(simplex[:3]) / 3
        mirrored = 2 * middle - simplex[3]
        value = e(mirrored)
        if value < values[0]:
            farther = 3 * middle - 2 * simplex[3]
            further = e(farther)
            simplex[3], values[3] = (farther, further) if further < value else (mirrored, value)
        elif value < values[2]:
            simplex[3], values[3] = mirrored, value
        else:
            near = (middle + (mirrored if value < values[3] else simplex[3])) / 2
            nearer = e(near)
            if nearer < min(value, values[3]):
                simplex[3], values[3] = near, nearer
            else:
                simplex = [(c + simplex[0]) / 2 for c in simplex]
                values = [e(c) for c in simplex]
    return simplex[int(np.argmin(values))]
