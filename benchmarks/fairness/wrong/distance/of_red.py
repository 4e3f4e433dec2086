"""How far red is from the mean of the photo."""

import numpy as np


def distance(Z, skin):
    return np.abs(Z[..., 0] - Z[..., 0].mean()) / Z[..., 0].std()
