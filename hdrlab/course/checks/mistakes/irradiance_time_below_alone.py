"""The time belongs above the fraction as well: sum w f t over sum w t^2."""


def irradiance(Z, t, f_inv, w):
    return (w[Z] * f_inv[Z]).sum(axis=1) / (w[Z] * t**2).sum(axis=1)
