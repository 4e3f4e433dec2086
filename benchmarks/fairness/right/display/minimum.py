"""As it stands."""

import numpy as np


def display(Lm, adaptation, white=np.inf):
    return np.minimum(Lm * (1 + Lm / white**2) / (1 + adaptation), 1)
