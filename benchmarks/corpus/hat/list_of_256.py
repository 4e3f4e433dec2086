import numpy as np


def hat(n=256):
    z_min, z_max = 0, 255
    z_mid = (z_min + z_max) // 2
    weights = []
    for z in range(256):
        if z <= z_mid:
            weights.append(z - z_min)
        else:
            weights.append(z_max - z)
    return np.array(weights)
