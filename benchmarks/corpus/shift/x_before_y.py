import numpy as np


def shift(images, offsets):
    # offsets as (x, y), as in the MTB paper
    xs = [int(o[0]) for o in offsets]
    ys = [int(o[1]) for o in offsets]
    n, h, w = np.shape(images)[:3]
    x0, x1 = max(0, max(xs)), w + min(0, min(xs))
    y0, y1 = max(0, max(ys)), h + min(0, min(ys))
    result = [images[i][y0 - ys[i] : y1 - ys[i], x0 - xs[i] : x1 - xs[i]] for i in range(n)]
    return np.array(result)
