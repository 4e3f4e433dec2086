"""Homographies: moving pictures, resampling them in linear light, and the part that all of them show.

H        homography (3, 3): H (x, y, 1) is where pixel (x, y) of one picture lies in another, up to a factor;
         (P, 3, 3), one for each photograph: where its pixels lie in the picture that they share
offsets  (P, 2), (dy, dx) pixels, down and right: homographies that only shift
a, b     half-planes (n, 2) and (n,): the points p with a p <= b

Pixels are points at whole coordinates; x counts columns and y rows, as OpenCV and scikit-image have
it.
"""

from collections.abc import Sequence
from functools import reduce

import numpy as np

from hdrlab.core.arrays import F64, Array, ArrayLike, describe
from hdrlab.core.optional import scipy_optimize as optimize, skimage_transform as transform
from hdrlab.errors import InputError

# A picture extends this far beyond its outer pixels, so that one of a single pixel has sides, too.
_BORDER_PIXELS = 1e-3


def as_homographies(homographies: ArrayLike, count: int | None = None) -> F64:
    """Return float64 (P, 3, 3) with H[2, 2] = 1, of offsets (P, 2) the shifts, or raise a ValueError.

    Examples
    --------
    >>> as_homographies([[3, -1]])[0].tolist()
    [[1.0, 0.0, -1.0], [0.0, 1.0, 3.0], [0.0, 0.0, 1.0]]
    """
    H = np.asarray(homographies)
    is_finite = H.dtype.kind in "iuf" and H.size > 0 and bool(np.isfinite(H).all())
    if not is_finite or H.shape[1:] not in ((2,), (3, 3)):
        raise InputError(
            f"expected finite homographies (P, 3, 3) or offsets (P, 2), got {describe(H)}"
        )
    if count is not None and len(H) != count:
        raise InputError(f"expected {count} homographies, one per image, got {len(H)}")
    if H.ndim == 2:
        shifts = np.tile(np.eye(3), (len(H), 1, 1))
        shifts[:, :2, 2] = H[:, ::-1]
        return shifts
    if np.any(np.abs(np.linalg.det(H)) < 1e-12) or np.any(np.abs(H[:, 2, 2]) < 1e-12):
        raise InputError("expected invertible homographies, got a matrix without an inverse")
    return H / H[:, 2:, 2:].astype(np.float64)


def turn(
    shape: tuple[int, ...], degrees: float, offset: ArrayLike = (0, 0), *, scale: float = 1.0
) -> F64:
    """Return H of a picture (H, W) turned about its middle, clockwise as seen, enlarged, then shifted."""
    dy, dx = np.asarray(offset, float)
    phi = np.deg2rad(degrees)
    cos = scale * np.cos(phi)
    sin = scale * np.sin(phi)
    y, x = (np.array(shape[:2]) - 1) / 2
    return np.array(
        [[cos, -sin, x - cos * x + sin * y + dx], [sin, cos, y - sin * x - cos * y + dy], [0, 0, 1]]
    )


def corners(shape: tuple[int, ...]) -> F64:
    """Return (x, y) of a picture's four corner pixels, (4, 2), in turn."""
    h = shape[0] - 1
    w = shape[1] - 1
    return np.array([[0, 0], [w, 0], [w, h], [0, h]], float)


def apply(H: ArrayLike, points: ArrayLike) -> F64:
    """Return where points (..., n, 2), (x, y), lie after H (..., 3, 3)."""
    H = np.asarray(H, float)
    points = np.asarray(points, float)
    x = points[..., 0]
    y = points[..., 1]
    u, v, w = [H[..., row, :1] * x + H[..., row, 1:2] * y + H[..., row, 2:] for row in range(3)]
    return np.stack([u / w, v / w], axis=-1)


def through(source: F64, target: F64) -> F64:
    """Return H (3, 3), H[2, 2] = 1, that takes the four points `source` (4, 2) to `target` (4, 2).

    x (h_31 u + h_32 v + 1) = h_11 u + h_12 v + h_13, and so for y: two equations per point, linear
    in H.
    """
    u, v = source.T
    x, y = target.T
    zeros = np.zeros(4)
    ones = np.ones(4)
    rows_x = np.column_stack([u, v, ones, zeros, zeros, zeros, -x * u, -x * v])
    rows_y = np.column_stack([zeros, zeros, zeros, u, v, ones, -y * u, -y * v])
    h = np.linalg.solve(np.vstack([rows_x, rows_y]), np.concatenate([x, y]))
    return np.append(h, 1.0).reshape(3, 3)


def corner_distance(found: ArrayLike, truth: ArrayLike, shape: tuple[int, ...]) -> F64:
    """Return how far two homographies (..., 3, 3) put the worst corner of a picture apart, pixels.

    Examples
    --------
    >>> float(corner_distance(turn((101, 101), 1), np.eye(3), (101, 101)).round(2))  # 70.7 pixels x pi / 180
    1.23
    """
    off = apply(found, corners(shape)) - apply(truth, corners(shape))
    return np.asarray(np.hypot(off[..., 0], off[..., 1]).max(axis=-1))


def chain_homographies(order: ArrayLike, steps: Sequence[F64]) -> F64:
    """Return the H (P, 3, 3) that align every image with the middle one of `order`.

    They are products of the P - 1 steps; step k aligns image order[k] with image order[k + 1].
    """
    H = np.tile(np.eye(3), (len(steps) + 1, 1, 1))
    order = np.asarray(order)
    middle = len(order) // 2
    for k in reversed(range(middle)):
        H[order[k]] = H[order[k + 1]] @ steps[k]
    for k in range(middle, len(steps)):
        H[order[k + 1]] = H[order[k]] @ np.linalg.inv(steps[k])
    return np.asarray(H / H[:, 2:, 2:])


def common_rectangle(homographies: ArrayLike, shape: tuple[int, ...]) -> tuple[slice, slice]:
    """Return the rectangle (rows, columns) of shared pixels that every moved picture of `shape` covers.

    It is the largest one of the pictures' own proportions, then widened as far as its sides go.

    Raises
    ------
    ValueError
        Where no pixel is covered by all of them.
    """
    H = as_homographies(homographies)
    wide = corners(shape) + _BORDER_PIXELS * np.sign(corners((3, 3)) - 1)
    if np.any(wide @ np.swapaxes(H[:, 2:, :2], 1, 2) + 1 <= 0):
        raise InputError("expected homographies that keep the image in front of the camera")
    quads = apply(H, wide)
    edges = np.roll(quads, -1, axis=1) - quads
    a = np.stack([edges[..., 1], -edges[..., 0]], axis=-1)
    orientation = np.sign(np.linalg.det(H[:, :2, :2]))  # -1 where H mirrors the picture
    length = np.hypot(a[..., 0], a[..., 1])
    a *= orientation[:, None, None] / length[..., None]
    b = np.einsum("pij,pij->pi", a, quads)
    left, top, right, bottom = _largest_rectangle(a.reshape(-1, 2), b.ravel(), shape)
    if left > right or top > bottom:
        raise InputError("expected homographies with which the images overlap")
    return slice(top, bottom + 1), slice(left, right + 1)


def _largest_rectangle(a: F64, b: F64, shape: tuple[int, ...]) -> list[int]:
    """Return left, top, right and bottom of the largest rectangle of pixels within half-planes.

    It is found by a linear program. Over a rectangle a p is largest at a corner: at its right where
    a_x > 0, and so on. So each half-plane is one inequality in the four sides.
    """
    A = np.hstack([np.minimum(a, 0), np.maximum(a, 0)])
    alike = np.array([[-1, 0, 1, 0, -shape[1]], [0, -1, 0, 1, -shape[0]]])  # high - low = s (W, H)
    limits = [(None, None)] * 4 + [(0, None)]
    result = optimize.linprog(
        [0, 0, 0, 0, -1], np.pad(A, ((0, 0), (0, 1))), b, alike, np.zeros(2), limits
    )
    if result.x is None:
        return [0, 0, -1, -1]  # an empty rectangle
    first = np.ceil(result.x[:2] - 2 * _BORDER_PIXELS)
    last = np.floor(result.x[2:4] + 2 * _BORDER_PIXELS)
    box = np.concatenate([first, last])
    for side, outwards in enumerate((-1, -1, 1, 1)):
        meets = np.abs(A[:, side]) > 1e-9
        room = np.min((b - A @ box)[meets] / np.abs(A[meets, side]))
        box[side] += outwards * max(np.floor(room + _BORDER_PIXELS), 0)
    return [int(side) for side in box]


def sample(image: ArrayLike, H: F64, shape: tuple[int, ...]) -> Array:
    """Return the picture (h, w[, C]) whose pixel p is `image` at H p, by cubic interpolation (Catmull-Rom).

    A value stays between the four pixels around its place, so that a lamp gets no dark ring. The
    light must be linear; beyond the border the last pixels go on.
    """
    image = np.asarray(image, np.float32)
    cubic = transform.warp(
        image,
        H,
        output_shape=shape[:2],
        order=3,
        mode="edge",
        clip=False,
        preserve_range=True,
    )
    more = np.pad(image, [(0, 1), (0, 1), (0, 0)][: image.ndim], mode="edge")
    four = more[:-1, :-1], more[:-1, 1:], more[1:, :-1], more[1:, 1:]
    low = before(reduce(np.minimum, four), H, shape)
    high = before(reduce(np.maximum, four), H, shape)
    return np.clip(cubic, low, high)


def nearest(image: Array, H: F64, shape: tuple[int, ...]) -> Array:
    """Return the picture (h, w[, C]) whose pixel p is the pixel of `image` nearest to H p."""
    return before(image, as_homographies([[0.5, 0.5]])[0] @ H, shape)


def before(image: Array, H: F64, shape: tuple[int, ...]) -> Array:
    """Return the picture (h, w[, C]) whose pixel p is the pixel of `image` just above and left of H p."""
    moved = np.empty((*shape[:2], *image.shape[2:]), image.dtype)
    across = H[:, :1] * np.arange(shape[1])
    last = np.array(image.shape[1::-1])[:, None] - 1
    for y, row in enumerate(moved):  # a row at a time stays in the processor's cache
        u, v, w = across + H[:, 1:2] * y + H[:, 2:]
        column, line = np.floor([u / w, v / w]).clip(0, last).astype(np.intp)
        row[:] = image[line, column]
    return moved
