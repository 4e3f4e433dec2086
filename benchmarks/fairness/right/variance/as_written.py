"""Three terms, in the order of the sheet."""


def variance(X, D, N, R):
    photons = X / N
    amplifier = (R / N) ** 2
    rounding = D**2 / 12
    return photons + amplifier + rounding
