"""By ranks of the distances, in float32, as a list of rows."""

import numpy as np
from scipy.stats import rankdata


def spot(shape, *, at=(0.5, 0.5), share=0.03):
    z = (np.arange(shape[0])[:, None] - at[0] * shape[0] + 0.5) + 1j * (
        np.arange(shape[1]) - at[1] * shape[1] + 0.5
    )
    ranks = rankdata(np.abs(z), method="ordinal").reshape(shape)
    k = max(1, round(share * z.size))
    return ((ranks <= k) / np.float32(k)).astype(np.float32).tolist()
