"""scipy's lfilter, fed with zeros after the object."""

import numpy as np
from scipy.signal import lfilter


def smear(x, h):
    after = np.zeros((len(h) - 1, *x.shape[1:]))
    return lfilter(h / len(h), [1.0], np.concatenate([x, after]), axis=0)
