import numpy as np


def shift(images, offsets):
    aligned = []
    for k in range(len(images)):
        img = np.roll(images[k], int(offsets[k][0]), axis=0)
        img = np.roll(img, int(offsets[k][1]), axis=1)
        aligned.append(img)
    return np.array(aligned)
