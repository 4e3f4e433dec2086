"""One pixel after the other; nested lists."""


def consistency(v, v_):
    rows = []
    for a, b in zip(v.tolist(), v_.tolist()):
        row = []
        for p, q in zip(a, b):
            d = min(1.0, max(abs(x - y) for x, y in zip(p, q)) * 255 / 16)
            row.append([2 * d**3 - 3 * d**2 + 1])
        rows.append(row)
    return rows
