import numpy as np


def update(Z, t, E, n=256):
    Em = E[:, None] * t[None, :]
    new = np.zeros(n)
    for m in range(n):
        here = (Z == m) & ~np.isnan(Em)
        card = here.sum()
        new[m] = Em[here].sum() / card if card > 0 else np.nan
    return new
