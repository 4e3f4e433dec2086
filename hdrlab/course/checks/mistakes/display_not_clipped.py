"""What is brighter than white stays white: clip at 1."""

import numpy as np


def display(Lm, adaptation, white=np.inf):
    return Lm / (1 + adaptation) * (1 + Lm / white**2)
