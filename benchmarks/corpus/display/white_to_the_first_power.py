import numpy as np


def display(Lm, adaptation, white=np.inf):
    scaled = (Lm * (1 + Lm / white)) / (1 + adaptation)
    return np.clip(scaled, 0, 1)
