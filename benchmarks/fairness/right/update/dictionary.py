"""A dictionary of lists in plain Python, with fsum for the sums."""

import math
from collections import defaultdict

import numpy as np


def update(Z, t, E, n=256):
    members = defaultdict(list)
    times = [float(x) for x in t]
    for levels, light in zip(np.asarray(Z).tolist(), np.asarray(E, dtype=float).tolist()):
        if math.isnan(light):
            continue
        for level, time in zip(levels, times):
            members[level].append(light * time)
    return np.array(
        [math.fsum(members[m]) / len(members[m]) if m in members else math.nan for m in range(n)]
    )
