import numpy as np


def tonemap(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    L = np.asarray(L, np.float64)
    lit = L[L > 0]
    if lit.size == 0:
        return np.zeros(L.shape, np.float32)
    Lw_bar = np.exp(np.mean(np.log(1e-6 * np.median(lit) + L)))
    Lm = key * L / Lw_bar
    if white is None:
        white = max(1.0, np.quantile(Lm, 0.9999))
    V = Lm
    if local:
        from scipy.ndimage import gaussian_filter

        sizes = [1.6**i for i in range(9)]
        blurs = [gaussian_filter(Lm, s / 4) for s in sizes]
        V = blurs[0].copy()
        going = np.ones(Lm.shape, bool)
        for i in range(8):
            v = (blurs[i] - blurs[i + 1]) / (2**phi * key / sizes[i] ** 2 + blurs[i])
            going &= np.abs(v) < threshold
            V[going] = blurs[i][going]
    Ld = Lm * (1 + Lm / white**2) / (1 + V)
    return Ld.astype(np.float32)
