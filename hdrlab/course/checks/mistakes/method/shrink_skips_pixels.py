"""You take every second pixel and drop the others: noise stays, and fine texture turns into patterns.
Average four."""


def shrink(Y):
    rows, columns = Y.shape[0] // 2 * 2, Y.shape[1] // 2 * 2
    return Y[:rows:2, :columns:2]
