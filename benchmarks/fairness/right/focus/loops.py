"""Pixel by pixel, with indices held inside."""


def focus(block, *, noise=20.0):
    h, w = block.shape
    rows = block.tolist()
    total = 0.0
    for y in range(h):
        for x in range(w):
            around = rows[max(y - 1, 0)][x] + rows[min(y + 1, h - 1)][x]
            around += rows[y][max(x - 1, 0)] + rows[y][min(x + 1, w - 1)]
            value = abs(around - 4 * rows[y][x])
            total += value if value > noise else 0
    return total / (h * w)
