"""g holds natural logarithms, and you subtract the logarithm to the base 2 of the times: take ln of both."""

import numpy as np

from hdrlab.radiance import merge as merging


def merge(images, times, g, w=None):
    return merging.merge(images, np.exp(np.log2(times)), g, w)
