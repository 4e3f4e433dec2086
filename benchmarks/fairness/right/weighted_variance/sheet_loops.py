import numpy as np


def weighted_variance(x, w):
    P, H, W = np.shape(x)
    v = np.zeros((H, W))
    for i in range(H):
        for j in range(W):
            total = 0.0
            mean = 0.0
            for p in range(P):
                total += float(w[p][i][j])
                mean += float(w[p][i][j]) * float(x[p][i][j])
            if total > 0:
                mean /= total
                acc = 0.0
                for p in range(P):
                    acc += float(w[p][i][j]) * (float(x[p][i][j]) - mean) ** 2
                v[i, j] = acc / total
    return v
