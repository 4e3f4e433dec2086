"""numpy's ceil, a float."""

import numpy as np


def count(scene, usable, overlap):
    return np.maximum(1 + np.ceil((scene - usable) / (usable - overlap)), 1.0)
