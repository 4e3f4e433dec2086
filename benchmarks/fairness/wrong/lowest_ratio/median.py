"""The median ratio, and the spread of all ratios."""

import numpy as np


def lowest_ratio(F, G):
    ratios = F[G > 0] / G[G > 0]
    return 0.1 * np.median(ratios), ratios.max() / np.median(ratios)
