"""Sorted pairs in plain Python."""


def spread(L, Ld, *, bins=64):
    pairs = sorted(zip(L.ravel().tolist(), Ld.ravel().tolist()))
    n = len(pairs) // bins
    classes = [pairs[i : i + n] for i in range(0, len(pairs), n)]
    return (
        [c[len(c) // 2][0] for c in classes],
        [min(d for _, d in c) for c in classes],
        [max(d for _, d in c) for c in classes],
    )
