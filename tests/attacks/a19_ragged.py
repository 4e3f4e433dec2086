"""Return a list of rows of unequal length."""


def double(x):
    return [[0.0] * n for n in range(4)]
