"""Known mistakes in `merge`, the task of hdrlab.radiance.merge.merge."""

import numpy as np

from hdrlab.core.weights import hat
from hdrlab.course.checks.mistakes import Question, mistake
from hdrlab.radiance.merge import CLIPPING_LEVEL, bound, weigh


@mistake(
    "merge_mean_of_radiance",
    says="You average the radiances. Average their logarithms: a bright outlier changes that "
    "mean less.",
    misses_method=True,
    questions=(
        Question(
            code="g = np.log(np.maximum(np.arange(256), 1))\n"
            "images = np.ones((2, 1, 1), np.uint8)\n"
            "merge(images, [1, 1], g, np.ones(256))[0, 0]",
            why="Here g(1) = 0 and all weights are equal, so each photo says E = 1 / t. Both say 1.",
            because=r"$$\ln E = \frac",
        ),
        Question(
            code="g = np.log(np.maximum(np.arange(256), 1))\n"
            "images = np.ones((2, 1, 1), np.uint8)\n"
            "merge(images, [1, 0.25], g, np.ones(256))[0, 0]",
            why="The photos say 1 and 4. The mean of ln 1 and ln 4 is ln 2.",
            because=r"$$\ln E = \frac",
        ),
        Question(
            code="g = np.log(np.maximum(np.arange(256), 1))\n"
            "images = np.ones((2, 1, 1), np.uint8)\n"
            "merge(images, [1, 0.01], g, np.ones(256))[0, 0]",
            why="The photos say 1 and 100. The mean of ln 1 and ln 100 is ln 10.",
            because=r"$$\ln E = \frac",
        ),
    ),
)
def mean_of_radiance(images, times, g, w=None):
    images = np.asarray(images)
    t = np.asarray(times, np.float64)
    g = np.asarray(g, np.float64)
    n = np.iinfo(images.dtype).max + 1
    Z = images.reshape(*images.shape[:3], -1)
    B = np.log(t)
    c = np.arange(Z.shape[-1])
    top = int(CLIPPING_LEVEL * (n - 1)) + 1
    g = np.broadcast_to(np.reshape(g, (n, -1)), (n, len(c)))
    W = weigh(Z, hat(n) if w is None else np.asarray(w), top)
    total = W.sum(axis=0)
    lE = np.log(
        np.sum(W * np.exp(g[Z, c] - B[:, None, None, None]), axis=0) / np.where(total > 0, total, 1)
    )
    E = np.where(total > 0, np.exp(lE), bound(Z, B, g, top, np.ones(Z.shape, bool))[0])
    return E.reshape(images.shape[1:]).astype(np.float32)


@mistake(
    "merge_by_the_number_of_frames",
    says="You divide by the number of photos. Divide by the sum of the weights; otherwise a pixel"
    " that only one photo measures is wrong.",
)
def by_the_number_of_frames(images, times, g, w=None):
    images = np.asarray(images)
    t = np.asarray(times, np.float64)
    g = np.asarray(g, np.float64)
    n = np.iinfo(images.dtype).max + 1
    Z = images.reshape(*images.shape[:3], -1)
    B = np.log(t)
    c = np.arange(Z.shape[-1])
    top = int(CLIPPING_LEVEL * (n - 1)) + 1
    g = np.broadcast_to(np.reshape(g, (n, -1)), (n, len(c)))
    W = weigh(Z, hat(n) if w is None else np.asarray(w), top)
    total = W.sum(axis=0)
    lE = np.sum(W * (g[Z, c] - B[:, None, None, None]), axis=0) / len(images)
    E = np.where(total > 0, np.exp(lE), bound(Z, B, g, top, np.ones(Z.shape, bool))[0])
    return E.reshape(images.shape[1:]).astype(np.float32)


@mistake(
    "merge_always_the_hat",
    says="You always use the hat. Look up the weights in w, and use the hat only if w is None.",
)
def always_the_hat(images, times, g, w=None):
    images = np.asarray(images)
    t = np.asarray(times, np.float64)
    g = np.asarray(g, np.float64)
    n = np.iinfo(images.dtype).max + 1
    Z = images.reshape(*images.shape[:3], -1)
    B = np.log(t)
    c = np.arange(Z.shape[-1])
    top = int(CLIPPING_LEVEL * (n - 1)) + 1
    g = np.broadcast_to(np.reshape(g, (n, -1)), (n, len(c)))
    W = weigh(Z, hat(n), top)
    total = W.sum(axis=0)
    lE = np.sum(W * (g[Z, c] - B[:, None, None, None]), axis=0) / np.where(total > 0, total, 1)
    E = np.where(total > 0, np.exp(lE), bound(Z, B, g, top, np.ones(Z.shape, bool))[0])
    return E.reshape(images.shape[1:]).astype(np.float32)


@mistake(
    "merge_green_curve_for_all",
    says="You use the green curve for every channel. g[:, c] belongs to channel c.",
)
def green_curve_for_all(images, times, g, w=None):
    images = np.asarray(images)
    t = np.asarray(times, np.float64)
    g = np.asarray(g, np.float64)
    n = np.iinfo(images.dtype).max + 1
    Z = images.reshape(*images.shape[:3], -1)
    B = np.log(t)
    c = np.arange(Z.shape[-1])
    top = int(CLIPPING_LEVEL * (n - 1)) + 1
    g = np.broadcast_to(np.reshape(g, (n, -1))[:, g.ndim - 1, None], (n, len(c)))
    W = weigh(Z, hat(n) if w is None else np.asarray(w), top)
    total = W.sum(axis=0)
    lE = np.sum(W * (g[Z, c] - B[:, None, None, None]), axis=0) / np.where(total > 0, total, 1)
    E = np.where(total > 0, np.exp(lE), bound(Z, B, g, top, np.ones(Z.shape, bool))[0])
    return E.reshape(images.shape[1:]).astype(np.float32)


@mistake(
    "merge_log2_of_the_times",
    says="g holds natural logarithms, but you subtract the base-2 logarithm of the times. Take "
    "ln of both.",
    questions=(
        Question(
            code="g = np.log(np.maximum(np.arange(256), 1))\n"
            "images = np.array([[[100]]], np.uint8)\n"
            "merge(images, [1], g)[0, 0]",
            why="Here g is the logarithm of the pixel value, as in a linear camera. One "
            "photo of 1 s: ln E = ln 100 - ln 1.",
            because=r"$\ln E = g(Z_j)",
        ),
        Question(
            code="g = np.log(np.maximum(np.arange(256), 1))\n"
            "images = np.array([[[100]]], np.uint8)\n"
            "merge(images, [2], g)[0, 0]",
            why="In twice the time, the same pixel value needs half the light: ln E = ln "
            "100 - ln 2, so E = 50.",
            because=r"$\ln E = g(Z_j)",
        ),
        Question(
            code="g = np.log(np.maximum(np.arange(256), 1))\n"
            "images = np.array([[[1]]], np.uint8)\n"
            "merge(images, [0.5], g)[0, 0]",
            why="ln E = ln 1 - ln 0.5 = ln 2, with the natural logarithm in both terms.",
            because=r"$\ln E = g(Z_j)",
        ),
    ),
)
def log2_of_the_times(images, times, g, w=None):
    images = np.asarray(images)
    t = np.asarray(times, np.float64)
    g = np.asarray(g, np.float64)
    n = np.iinfo(images.dtype).max + 1
    Z = images.reshape(*images.shape[:3], -1)
    B = np.log2(t)
    c = np.arange(Z.shape[-1])
    top = int(CLIPPING_LEVEL * (n - 1)) + 1
    g = np.broadcast_to(np.reshape(g, (n, -1)), (n, len(c)))
    W = weigh(Z, hat(n) if w is None else np.asarray(w), top)
    total = W.sum(axis=0)
    lE = np.sum(W * (g[Z, c] - B[:, None, None, None]), axis=0) / np.where(total > 0, total, 1)
    E = np.where(total > 0, np.exp(lE), bound(Z, B, g, top, np.ones(Z.shape, bool))[0])
    return E.reshape(images.shape[1:]).astype(np.float32)


@mistake(
    "merge_power_of_two",
    says="g holds natural logarithms, so the inverse of ln E is exp. You used a power of 2.",
)
def power_of_two(images, times, g, w=None):
    images = np.asarray(images)
    t = np.asarray(times, np.float64)
    g = np.asarray(g, np.float64)
    n = np.iinfo(images.dtype).max + 1
    Z = images.reshape(*images.shape[:3], -1)
    B = np.log(t)
    c = np.arange(Z.shape[-1])
    top = int(CLIPPING_LEVEL * (n - 1)) + 1
    g = np.broadcast_to(np.reshape(g, (n, -1)), (n, len(c)))
    W = weigh(Z, hat(n) if w is None else np.asarray(w), top)
    total = W.sum(axis=0)
    lE = np.sum(W * (g[Z, c] - B[:, None, None, None]), axis=0) / np.where(total > 0, total, 1)
    E = np.where(total > 0, np.exp2(lE), bound(Z, B, g, top, np.ones(Z.shape, bool))[0])
    return E.reshape(images.shape[1:]).astype(np.float32)


@mistake(
    "merge_times_forgotten",
    says="exp(g) is the exposure, irradiance times time. Divide by each photo's time; "
    "otherwise photos of one scene disagree.",
)
def times_forgotten(images, times, g, w=None):
    images = np.asarray(images)
    t = np.asarray(times, np.float64)
    g = np.asarray(g, np.float64)
    n = np.iinfo(images.dtype).max + 1
    Z = images.reshape(*images.shape[:3], -1)
    B = 0 * t
    c = np.arange(Z.shape[-1])
    top = int(CLIPPING_LEVEL * (n - 1)) + 1
    g = np.broadcast_to(np.reshape(g, (n, -1)), (n, len(c)))
    W = weigh(Z, hat(n) if w is None else np.asarray(w), top)
    total = W.sum(axis=0)
    lE = np.sum(W * (g[Z, c] - B[:, None, None, None]), axis=0) / np.where(total > 0, total, 1)
    E = np.where(total > 0, np.exp(lE), bound(Z, B, g, top, np.ones(Z.shape, bool))[0])
    return E.reshape(images.shape[1:]).astype(np.float32)


@mistake(
    "merge_not_weighted",
    says="All photos count the same in your mean, so noisy dark values and nearly clipped values "
    "have full weight.",
    misses_method=True,
)
def not_weighted(images, times, g, w=None):
    images = np.asarray(images)
    t = np.asarray(times, np.float64)
    g = np.asarray(g, np.float64)
    n = np.iinfo(images.dtype).max + 1
    Z = images.reshape(*images.shape[:3], -1)
    B = np.log(t)
    c = np.arange(Z.shape[-1])
    top = int(CLIPPING_LEVEL * (n - 1)) + 1
    g = np.broadcast_to(np.reshape(g, (n, -1)), (n, len(c)))
    W = weigh(Z, np.ones(n), top)
    total = W.sum(axis=0)
    lE = np.sum(W * (g[Z, c] - B[:, None, None, None]), axis=0) / np.where(total > 0, total, 1)
    E = np.where(total > 0, np.exp(lE), bound(Z, B, g, top, np.ones(Z.shape, bool))[0])
    return E.reshape(images.shape[1:]).astype(np.float32)


@mistake(
    "merge_clipped_levels_count",
    says="Your hat is not 0 at pixel values 0 and 255, so clipped pixels count. Use "
    "min(z, 255 - z), which is 0 at both ends.",
    questions=(
        Question(
            code="g = np.log(np.maximum(np.arange(256), 1))\n"
            "images = np.array([[[50]], [[200]]], np.uint8)\n"
            "merge(images, [1, 4], g)[0, 0]",
            why="Here g is the logarithm of the pixel value, as in a linear camera. Both "
            "photos say 50 / 1 = 200 / 4 = 50.",
            because=r"$$\ln E = \frac",
        ),
        Question(
            code="g = np.log(np.maximum(np.arange(256), 1))\n"
            "images = np.array([[[2]], [[255]]], np.uint8)\n"
            "merge(images, [1, 200], g)[0, 0]",
            why="The value 255 is clipped and has the weight 0. Only the first photo "
            "counts: 2 / 1.",
            because="If it is not given, use the hat",
        ),
        Question(
            code="g = np.log(np.maximum(np.arange(256), 1))\n"
            "images = np.array([[[0]], [[4]]], np.uint8)\n"
            "merge(images, [1, 8], g)[0, 0]",
            why="The value 0 has the weight 0, too. Only the second photo counts: 4 / 8.",
            because="If it is not given, use the hat",
        ),
    ),
    fixes=(
        ("z + 1", "z"),
        ("n - z", "n - 1 - z"),
        ("256 - z", "255 - z"),
    ),
)
def clipped_levels_count(images, times, g, w=None):
    images = np.asarray(images)
    t = np.asarray(times, np.float64)
    g = np.asarray(g, np.float64)
    n = np.iinfo(images.dtype).max + 1
    Z = images.reshape(*images.shape[:3], -1)
    c = np.arange(Z.shape[-1])
    g = np.broadcast_to(np.reshape(g, (n, -1)), (n, len(c)))
    z = np.arange(n)
    table = np.minimum(z + 1, n - z) if w is None else np.asarray(w)
    W = table[Z]
    lE = np.sum(W * (g[Z, c] - np.log(t)[:, None, None, None]), axis=0) / W.sum(axis=0)
    return np.exp(lE).reshape(images.shape[1:]).astype(np.float32)


@mistake(
    "merge_sum_of_weights_plus_1",
    says="Your sum of weights does not start at 0, so all radiances are pulled toward 1. Start both "
    "sums at 0, and treat pixels without any weight separately.",
)
def sum_of_weights_plus_1(images, times, g, w=None):
    images = np.asarray(images)
    g = np.asarray(g, np.float64)
    Z = images.reshape(*images.shape[:3], -1)
    c = np.arange(Z.shape[-1])
    g = np.broadcast_to(np.reshape(g, (len(g), -1)), (len(g), len(c)))
    z = np.arange(len(g))
    W = (np.minimum(z, len(g) - 1 - z) if w is None else np.asarray(w))[Z]
    lE = np.sum(W * (g[Z, c] - np.log(times)[:, None, None, None]), axis=0) / (1 + W.sum(axis=0))
    return np.exp(lE).reshape(images.shape[1:])
