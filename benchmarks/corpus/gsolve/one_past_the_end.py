import numpy as np


def gsolve(Z, B, smoothness, w):
    n = len(w)
    l = smoothness
    A = np.zeros((Z.shape[0] * Z.shape[1] + n + 1, n + Z.shape[0]))
    b = np.zeros(A.shape[0])
    k = 0
    for i in range(Z.shape[0]):
        for j in range(Z.shape[1]):
            wij = w[Z[i, j]]
            A[k, Z[i, j]] = wij
            A[k, n + i] = -wij
            b[k] = wij * B[j]
            k += 1
    A[k, n // 2] = 1
    k += 1
    for i in range(n - 2):
        A[k, i] = l * w[i + 1]
        A[k, i + 1] = -2 * l * w[i + 1]
        A[k, i + 2] = l * w[i + 1]
        k += 1
    x = np.linalg.lstsq(A, b, rcond=None)[0]
    return x[:n], x[n + 1 :]
