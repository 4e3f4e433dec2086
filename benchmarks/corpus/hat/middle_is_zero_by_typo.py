import numpy as np


def hat(n=256):
    z_min, z_max = 0, n - 1
    z_mid = (z_min + z_min) // 2
    w = np.zeros(n)
    for z in range(n):
        if z > z_mid:
            w[z] = z_max - z
        else:
            w[z] = z - z_min
    return w
