"""The bracket only where white is finite, computed as (Lm / white)^2; always float32."""

import numpy as np


def display(Lm, adaptation, white=np.inf):
    Lm = np.asarray(Lm, dtype=np.float64)
    numerator = Lm
    if np.isfinite(white):
        numerator = Lm + (Lm / white) ** 2
    Ld = numerator / (1 + np.asarray(adaptation, dtype=np.float64))
    Ld[Ld > 1] = 1
    return Ld.astype(np.float32)
