"""All widths at once: accumulated masks, the last even width by counting; a list of tuples."""

import numpy as np


def scale_steps(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    stack = np.stack(list(blurred))
    widths = 1.6 ** np.arange(len(stack) - 1)
    V1, V2 = stack[:-1], stack[1:]
    V = (V1 - V2) / ((2.0**phi * key / widths**2)[:, None, None] + V1)
    even = np.logical_and.accumulate(np.abs(V) < threshold, axis=0)
    last = np.maximum(np.cumsum(even, axis=0) - 1, 0)
    adaptation = np.take_along_axis(stack, last, axis=0)
    return [(float(s), *step) for s, *step in zip(widths, V1, V, even, adaptation)]
