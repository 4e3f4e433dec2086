"""For each rank the level is found by bisection on B's cumulated share, which is a broken line."""

import numpy as np


def brightness_transfer(h_A, h_B):
    n = len(h_A)
    share = np.concatenate(([0.0], np.cumsum(h_B, dtype=float))) / np.sum(h_B)

    def below(level):
        whole = int(np.floor(level + 0.5))
        whole = min(max(whole, 0), n - 1)
        return share[whole] + (level + 0.5 - whole) * (share[whole + 1] - share[whole])

    answers, counted = [], 0.0
    for count in h_A:
        rank = (counted + 0.5 * count) / float(np.sum(h_A))
        counted += count
        low, high = -0.5, n - 0.5
        for _ in range(50):
            middle = (low + high) / 2
            low, high = (middle, high) if below(middle) < rank else (low, middle)
        answers.append(low if 0.5 < low < n - 1.5 else float("nan"))
    return answers
