import numpy as np


def shift(images, offsets):
    images = np.asarray(images)
    offsets = np.asarray(offsets, dtype=int)
    H, W = images.shape[1:3]
    top = max(0, offsets[:, 0].max())
    bottom = min(H, H + offsets[:, 0].min())
    left = max(0, offsets[:, 1].max())
    right = min(W, W + offsets[:, 1].min())
    out = []
    for img, (dy, dx) in zip(images, offsets):
        out.append(img[top - dy : bottom - dy, left - dx : right - dx])
    return np.stack(out)
