import numpy as np


def half(img):
    h, w = img.shape[0] // 2 * 2, img.shape[1] // 2 * 2
    a = img[:h, :w].astype(np.float64)
    return np.round((a[::2, ::2] + a[1::2, ::2] + a[::2, 1::2] + a[1::2, 1::2]) / 4)


def bitmaps(img):
    med = np.sort(img.ravel())[(img.size - 1) // 2]
    tb = img > med
    eb = (img >= med - 4) & (img <= med + 4)
    return tb, eb


def count_error(a, b, dy, dx):
    tb1, eb1 = a
    tb2, eb2 = b
    h, w = tb1.shape
    y0, y1, x0, x1 = max(0, dy), min(h, h + dy), max(0, dx), min(w, w + dx)
    if y0 >= y1 or x0 >= x1:
        return 1.0
    s1 = (slice(y0, y1), slice(x0, x1))
    s2 = (slice(y0 - dy, y1 - dy), slice(x0 - dx, x1 - dx))
    diff = np.logical_xor(tb1[s1], tb2[s2])
    diff = diff & eb1[s1] & eb2[s2]
    return diff.mean()


def get_exp_shift(img1, img2, bits):
    if bits > 1 and min(img1.shape) >= 16:
        cy, cx = get_exp_shift(half(img1), half(img2), bits - 1)
        cy, cx = 2 * cy, 2 * cx
    else:
        cy, cx = 0, 0
    a, b = bitmaps(img1), bitmaps(img2)
    best = (cy, cx)
    min_err = count_error(a, b, cy, cx)
    for i in (-1, 0, 1):
        for j in (-1, 0, 1):
            err = count_error(a, b, cy + i, cx + j)
            if err < min_err:
                min_err = err
                best = (cy + i, cx + j)
    return best


def align(images, *, bits=6, luma=False):
    images = np.asarray(images)
    gray = [
        (54.0 * im[..., 0] + 183.0 * im[..., 1] + 19.0 * im[..., 2]) // 256
        if im.ndim == 3
        else im * 1.0
        for im in images
    ]
    order = sorted(range(len(gray)), key=lambda k: gray[k].mean())
    offsets = np.zeros((len(gray), 2), int)
    mid = len(order) // 2
    for k in range(mid - 1, -1, -1):
        offsets[order[k]] = offsets[order[k + 1]] + get_exp_shift(
            gray[order[k + 1]], gray[order[k]], bits
        )
    for k in range(mid + 1, len(order)):
        offsets[order[k]] = offsets[order[k - 1]] + get_exp_shift(
            gray[order[k - 1]], gray[order[k]], bits
        )
    return offsets
