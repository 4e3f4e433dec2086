"""The plain variance."""


def weighted_variance(x, w):
    return x.var(axis=0)
