"""A list of numbers."""


def hat(n=256):
    return [min(z, n - 1 - z) / ((n - 1) // 2) for z in range(n)]
