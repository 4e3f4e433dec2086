"""From the unit square in closed form, once forwards and once backwards."""

import numpy as np


def of_square(p):
    (x0, y0), (x1, y1), (x2, y2), (x3, y3) = p
    sx, sy = x0 - x1 + x2 - x3, y0 - y1 + y2 - y3
    a, b, c, d = x1 - x2, x3 - x2, y1 - y2, y3 - y2
    det = a * d - b * c
    g, h = (sx * d - b * sy) / det, (a * sy - sx * c) / det
    return np.array(
        [
            [x1 - x0 + g * x1, x3 - x0 + h * x3, x0],
            [y1 - y0 + g * y1, y3 - y0 + h * y3, y0],
            [g, h, 1],
        ]
    )


def homography(source, target):
    H = of_square(target).dot(np.linalg.inv(of_square(source)))
    return H * (1 / H[-1, -1])
