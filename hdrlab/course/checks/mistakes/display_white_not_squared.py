"""White is squared: Lm / white^2. As you have it, Lm = white comes out above 1, and is clipped long
before."""

import numpy as np


def display(Lm, adaptation, white=np.inf):
    return np.minimum(Lm / (1 + adaptation) * (1 + Lm / white), 1)
