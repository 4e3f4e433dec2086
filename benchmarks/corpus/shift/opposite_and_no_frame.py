import numpy as np


def shift(images, offsets):
    images = np.asarray(images)
    off = -np.asarray(offsets).astype(int)
    H, W = images.shape[1], images.shape[2]
    y0 = max(off[:, 0])
    x0 = max(off[:, 1])
    height = H - (max(off[:, 0]) - min(off[:, 0]))
    width = W - (max(off[:, 1]) - min(off[:, 1]))
    res = []
    for i in range(images.shape[0]):
        a = y0 - off[i, 0]
        b = x0 - off[i, 1]
        res.append(images[i, a : a + height, b : b + width])
    return np.stack(res)
