"""scipy's Mahalanobis distance."""

import numpy as np
from scipy.spatial.distance import cdist


def distance(Z, skin):
    rgb = np.reshape(Z, (-1, 3))
    Y = np.clip(rgb.dot(np.array([0.299, 0.587, 0.114])), 1, None)
    x = rgb.dot(np.array([[-0.168736, 0.5], [-0.331264, -0.418688], [0.5, -0.081312]]))
    x *= 128 / Y[:, np.newaxis]
    d = cdist(x, np.atleast_2d(skin[0]), metric="mahalanobis", VI=np.linalg.inv(skin[1]))
    return d.reshape(Z.shape[:-1])
