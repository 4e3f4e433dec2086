"""Plain loops over lists."""


def contrast(block):
    counts = [0] * 256
    for value in block.ravel().tolist():
        counts[round(value)] += 1
    smooth = [sum(counts[max(i - 2, 0) : i + 3]) / 5 for i in range(256)]
    total = sum(smooth)
    mean = sum(i * n for i, n in enumerate(smooth)) / total
    return sum(abs(i - mean) * n for i, n in enumerate(smooth)) / total
