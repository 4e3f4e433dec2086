"""Every camera is a television."""


def fit_exponent(ladders, *, alpha=0.0):
    return 1 / 2.2
