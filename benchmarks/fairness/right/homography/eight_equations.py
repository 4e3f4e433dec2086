"""The linear system of the sheet, row by row."""

import numpy as np


def homography(source, target):
    A, b = [], []
    for (u, v), (x, y) in zip(source, target):
        A.append([u, v, 1, 0, 0, 0, -x * u, -x * v])
        A.append([0, 0, 0, u, v, 1, -y * u, -y * v])
        b += [x, y]
    return np.array([*np.linalg.solve(A, b), 1]).reshape(3, 3)
