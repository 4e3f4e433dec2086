"""A line through each power, by polyfit."""

import numpy as np


def quadratic_form(blends, degree):
    Q = np.zeros((degree + 1, degree + 1))
    for I, M in blends:
        R = []
        for k in range(degree + 1):
            line = np.polyfit(I, M**k, 1)
            R.append(M**k - np.polyval(line, I))
        Q += np.array(R) @ np.array(R).T
    return Q
