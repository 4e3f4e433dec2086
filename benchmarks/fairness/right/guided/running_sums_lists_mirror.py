"""Plain Python lists with a running sum along rows, then columns, mirrored about the edge pixel; the result
is a list of lists."""

import numpy as np


def guided(I, p=None, *, radius, epsilon):
    if p is None:
        p = I
    n = 2 * radius + 1

    def place(i, size):
        # ... 2 1 0 1 2 ... size-2 size-1 size-2 ...
        if size == 1:
            return 0
        i = i % (2 * size - 2)
        return i if i < size else 2 * size - 2 - i

    def along(row):
        size = len(row)
        total = sum(row[place(k, size)] for k in range(-radius, radius + 1))
        out = [total / n]
        for k in range(1, size):
            total += row[place(k + radius, size)] - row[place(k - radius - 1, size)]
            out.append(total / n)
        return out

    def mean(f):
        rows = [along(row) for row in f]
        columns = [along(list(column)) for column in zip(*rows)]
        return [list(row) for row in zip(*columns)]

    def each(function, *pictures):
        return [[function(*values) for values in zip(*rows)] for rows in zip(*pictures)]

    I = np.asarray(I, dtype=float).tolist()
    p = np.asarray(p, dtype=float).tolist()
    mI, mp = mean(I), mean(p)
    mII = mean(each(lambda i: i * i, I))
    mIp = mean(each(lambda i, s: i * s, I, p))
    a = each(lambda ip, i, s, ii: (ip - i * s) / (ii - i * i + epsilon), mIp, mI, mp, mII)
    b = each(lambda s, slope, i: s - slope * i, mp, a, mI)
    return each(lambda slope, i, c: slope * i + c, mean(a), I, mean(b))
