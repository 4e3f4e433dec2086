def irradiance(Z, t, f_inv, w):
    W = w[Z]
    num = (W * f_inv[Z]).sum(axis=1)
    den = (W * t).sum(axis=1)
    den[den == 0] = 1
    return num / den
