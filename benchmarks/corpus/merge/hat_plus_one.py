import numpy as np


def merge(images, times, g, w=None):
    images = np.asarray(images)
    if w is None:
        w = np.array([z + 1 if z < 128 else 256 - z for z in range(256)])
    g = np.asarray(g)
    shape = images.shape[1:]
    num = np.zeros(shape)
    den = np.zeros(shape)
    for j, img in enumerate(images):
        if img.ndim == 3 and g.ndim == 2:
            gz = np.stack([g[img[..., c], c] for c in range(img.shape[2])], axis=-1)
        else:
            gz = g[img]
        num += w[img] * (gz - np.log(times[j]))
        den += w[img]
    den[den == 0] = 1
    return np.exp(num / den)
