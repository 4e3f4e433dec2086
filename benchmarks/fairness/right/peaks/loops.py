"""Loops over all places; a list of tuples."""


def peaks(c, count):
    H, W = c.shape
    found = []
    for i in range(H):
        for j in range(W):
            around = c[max(i - 2, 0) : i + 3, max(j - 2, 0) : j + 3]
            if c[i, j] > 0 and c[i, j] >= around.max():
                found.append((float(c[i, j]), i - (H - 1) // 2, j - (W - 1) // 2))
    found.sort(reverse=True)
    return [(dy, dx) for _, dy, dx in found[:count]]
