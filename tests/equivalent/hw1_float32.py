"""Homework 1 in float32, with photos as numbers from 0 to 1."""

# %%
import numpy as np

f32 = np.float32

# %% task="ev"


def ev(F, T, *, S=100.0):
    return f32(2) * np.log2(f32(F)) - np.log2(np.asarray(T, f32)) - np.log2(f32(S) / f32(100))


# %% task="equivalent_time"


def equivalent_time(T, F, F_new, *, S=100, S_new=100):
    return f32(T) * (f32(F_new) / f32(F)) ** f32(2) * (f32(S) / f32(S_new))


# %% task="count"


def count(scene, usable, overlap):
    return f32(max(1.0, 1 + np.ceil((scene - usable) / (usable - overlap))))


# %% task="threshold"


def threshold(h, q):
    share = np.cumsum(h, dtype=float) / np.sum(h)
    return np.argmax(share >= np.asarray(q)[..., None] - 1e-12, axis=-1).astype(f32)


# %% task="exclusion"


def exclusion(Y, t):
    return (np.abs(Y.astype(f32) - f32(t)) > f32(4)).astype(np.uint8)


# %% task="shrink"


def shrink(Y):
    H, W = Y.shape[0] // 2, Y.shape[1] // 2
    return Y[: 2 * H, : 2 * W].astype(f32).reshape(H, 2, W, 2).mean(axis=(1, 3))


# %% task="shift"


def shift(images, offsets):
    low, high = np.minimum(offsets.min(axis=0), 0), np.maximum(offsets.max(axis=0), 0)
    H, W = images.shape[1:3]
    moved = []
    for image, (dy, dx) in zip(images.astype(f32), offsets, strict=True):
        rows, columns = slice(high[0] - dy, H + low[0] - dy), slice(high[1] - dx, W + low[1] - dx)
        moved.append(image[rows, columns])
    return np.array(moved)


# %% task="align"


class Bitmaps:
    """A level's bitmap and exclusion bitmap."""

    def __init__(self, Y):
        t = np.median(Y)
        self.bits, self.kept = Y > t, np.abs(Y - t) > f32(4 / 255)


def levels(Y, bits):
    pyramid = [Y]
    while len(pyramid) < bits and min(pyramid[-1].shape) >= 16:
        H, W = pyramid[-1].shape[0] // 2, pyramid[-1].shape[1] // 2
        pyramid.append(pyramid[-1][: 2 * H, : 2 * W].reshape(H, 2, W, 2).mean(axis=(1, 3)))
    return [Bitmaps(Y) for Y in pyramid]


def moved(mask, dy, dx):
    """Return the mask moved, False where nothing comes in."""
    H, W = mask.shape
    wide = np.zeros((H + 2 * abs(dy), W + 2 * abs(dx)), bool)
    wide[abs(dy) + dy : abs(dy) + dy + H, abs(dx) + dx : abs(dx) + dx + W] = mask
    return wide[abs(dy) : abs(dy) + H, abs(dx) : abs(dx) + W]


def pair(fixed, moving, bits):
    y = x = 0
    for A, B in list(zip(levels(fixed, bits), levels(moving, bits), strict=True))[::-1]:
        y, x = 2 * y, 2 * x
        errors = {}
        for dy, dx in sorted(
            ((i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)), key=lambda d: d[0] ** 2 + d[1] ** 2
        ):
            kept = A.kept & moved(B.kept, y + dy, x + dx)
            errors[dy, dx] = f32(((A.bits ^ moved(B.bits, y + dy, x + dx)) & kept).sum()) / f32(
                max(kept.sum(), 1)
            )
        dy, dx = min(errors, key=errors.get)
        y, x = y + dy, x + dx
    return np.array([y, x])


def align(images, *, bits=6, luma=False):
    Y = images.astype(f32) / f32(255)
    Y = Y[..., 1] if Y.ndim == 4 else Y
    order = np.argsort(Y.mean(axis=(1, 2)), kind="stable")
    steps = [pair(Y[b], Y[a], bits) for a, b in zip(order[:-1], order[1:], strict=True)]
    along = np.concatenate([np.zeros((1, 2)), -np.cumsum(steps, axis=0).reshape(-1, 2)])
    offsets = np.empty((len(Y), 2), f32)
    offsets[order] = along - along[len(Y) // 2]
    return offsets
