"""exp(g) is the exposure, light times time: you forgot to divide by each frame's time, so frames of one
scene disagree."""

import numpy as np

from hdrlab.radiance import merge as merging


def merge(images, times, g, w=None):
    return merging.merge(images, np.ones(len(times)), g, w)
