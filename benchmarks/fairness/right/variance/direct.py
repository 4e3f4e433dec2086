"""Each of the three variances in exposures, summed."""


def variance(X, D, N, R):
    return X / N + (R / N) ** 2 + D**2 / 12
