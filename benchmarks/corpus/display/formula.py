import numpy as np


def display(Lm, adaptation, white=np.inf):
    Ld = Lm * (1 + Lm / white**2) / (1 + adaptation)
    return np.minimum(Ld, 1)
