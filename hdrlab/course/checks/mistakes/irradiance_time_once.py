"""Below the fraction the time is squared: sum w t^2. Yours weights frames as if all light were counted in
one bin."""


def irradiance(Z, t, f_inv, w):
    return (w[Z] * f_inv[Z]).sum(axis=1) / (w[Z] * t).sum(axis=1)
