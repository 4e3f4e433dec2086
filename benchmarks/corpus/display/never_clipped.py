import numpy as np


def display(Lm, adaptation, white=np.inf):
    top = Lm * (1.0 + Lm / (white * white))
    return top / (1.0 + adaptation)
