import numpy as np


def display(Lm, adaptation, white=np.inf):
    return (Lm * (1 + Lm / white**2)) / (1 + Lm)
