"""Only the middle goes to the middle."""

import numpy as np


def homography(source, target):
    H = np.eye(3)
    H[:2, 2] = target.mean(axis=0) - source.mean(axis=0)
    return H
