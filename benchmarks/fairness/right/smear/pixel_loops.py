"""Two loops over pixels and chops; lists."""


def smear(x, h):
    n, m = len(x), len(h)
    y = [0 * x[0] for _ in range(n + m - 1)]
    for i in range(n + m - 1):
        for k in range(m):
            if 0 <= i - k < n:
                y[i] = y[i] + h[k] * x[i - k] / m
    return [list(row) if hasattr(row, "__len__") else float(row) for row in y]
