"""Falls with the square of the distance."""

import numpy as np


def centre(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    y, x = np.indices(shape) + 0.5
    w = np.maximum(1 - (y / shape[0] - at[0]) ** 2 - (x / shape[1] - at[1]) ** 2, 0)
    return w / w.sum()
