"""Reading a grid of patches from a photograph, by its four corners.

corners  (4, 2) pixels (x, y)   of the corner patches, outside: top left, top right, bottom right, bottom left
u, v     grid coordinates       a patch is 1 wide: column k begins at u = k (1 + gap), and so for rows and v
gap      space between patches  over a patch's width
H        homography (3, 3)      (u, v, 1) -> (x, y, 1) times a factor
M        mean brightness        (rows, columns[, 3]), 0 to 1

A plane seen by a camera without distortion is a homography away from the photograph; four corners fix its
eight numbers.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core.arrays import Array, as_stack, describe, levels

Float = NDArray[np.float64]


def homography(source: ArrayLike, target: ArrayLike) -> Float:
    """Return H (3, 3), H[2, 2] = 1, that takes the four points `source` (4, 2) to `target` (4, 2).

    x (h_31 u + h_32 v + 1) = h_11 u + h_12 v + h_13, and so for y: two equations per point, linear in H.

    Raises
    ------
    ValueError
        For points that are not four, or three of which lie on one line.

    Examples
    --------
    >>> square = [[0, 0], [1, 0], [1, 1], [0, 1]]
    >>> homography(square, [[5, 5], [7, 5], [7, 7], [5, 7]]).round(9) + 0.0
    array([[2., 0., 5.],
           [0., 2., 5.],
           [0., 0., 1.]])
    """
    points = [np.asarray(one, np.float64) for one in (source, target)]
    for corners in points:
        if corners.shape != (4, 2) or not np.all(np.isfinite(corners)):
            raise ValueError(f"expected four corners (4, 2), (x, y) in pixels, got {describe(corners)}")
        if _flattest(corners) < 1e-6:
            raise ValueError(f"expected corners of which no three lie on a line, got {corners.tolist()}")
    (u, v), (x, y) = (corners.T for corners in points)
    zero, one = np.zeros(4), np.ones(4)
    A = np.vstack(
        [
            np.column_stack([u, v, one, zero, zero, zero, -x * u, -x * v]),
            np.column_stack([zero, zero, zero, u, v, one, -y * u, -y * v]),
        ]
    )
    return np.append(np.linalg.solve(A, np.r_[x, y]), 1.0).reshape(3, 3)


def _flattest(points: Float) -> float:
    """Return the least area of the four triangles among the points, over their extent squared."""
    trios = [np.delete(points, k, axis=0) for k in range(4)]
    areas = [abs(np.linalg.det(np.diff(trio, axis=0))) for trio in trios]
    return float(min(areas) / max(np.ptp(points) ** 2, 1e-12))


def to_grid(shape: tuple[int, int], H: Float) -> tuple[Float, Float]:
    """Return u and v (H, W) of every pixel's centre: H^-1 (x, y, 1), made (u, v, 1)."""
    y, x = np.indices(shape)
    u, v, w = np.tensordot(np.linalg.inv(H), np.stack([x, y, np.ones(shape)]), axes=1)
    w = np.where(w == 0, np.nan, w)
    return u / w, v / w


def patch_of(
    shape: tuple[int, int],
    corners: ArrayLike,
    rows: int,
    columns: int,
    *,
    gap: float = 0.0,
    core: float = 0.6,
) -> NDArray[np.intp]:
    """Return for every pixel (H, W) the number of the patch whose core it lies in, row by row; -1 for none.

    The core, that fraction of a patch's width and height, leaves out what edges and the lens have mixed.
    """
    if rows < 1 or columns < 1 or not gap >= 0 or not 0 < core <= 1:
        raise ValueError(
            f"expected rows, columns > 0, gap >= 0 and 0 < core <= 1, got {rows, columns, gap, core}"
        )
    wide, high = columns + gap * (columns - 1), rows + gap * (rows - 1)
    H = homography(np.array([[0, 0], [wide, 0], [wide, high], [0, high]]), corners)
    u, v = to_grid(shape, H)
    if np.any(np.asarray(corners) < -0.5) or np.any(np.asarray(corners) > np.array(shape)[::-1] - 0.5):
        raise ValueError(
            f"expected corners within a picture of {shape} pixels, got {np.asarray(corners).tolist()}"
        )
    with np.errstate(invalid="ignore"):
        column, row = np.floor(u / (1 + gap)), np.floor(v / (1 + gap))
        inside = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
        for at, first in ((u, column), (v, row)):
            inside &= np.abs(at - first * (1 + gap) - 0.5) <= core / 2
    number = np.full(shape, -1, np.intp)
    number[inside] = (row[inside] * columns + column[inside]).astype(np.intp)
    return number


def read(image: ArrayLike, corners: ArrayLike, rows: int, columns: int, **knobs: float) -> Float:
    """Return the mean brightness of each patch's core, 0 to 1.

    Parameters
    ----------
    image : (H, W) or (H, W, 3) uint8 or uint16
        A photograph of the grid.
    corners : (4, 2)
        Pixels (x, y), outer corners of the corner patches: top left, top right, bottom right, bottom left as
        the grid counts them, however the photograph is turned.
    rows, columns : int
        Of the grid.
    gap : float
        Space between two patches, over a patch's width.
    core : float
        The fraction of a patch's width and height that is read, 0.6.

    Returns
    -------
    (rows, columns) or (rows, columns, 3) float64

    Raises
    ------
    ValueError
        For an image or corners that are none, or patches too small to hold a pixel.

    Examples
    --------
    >>> image = np.kron([[0, 51], [102, 255]], np.ones((9, 9))).astype(np.uint8)
    >>> read(image, [[-0.5, -0.5], [17.5, -0.5], [17.5, 17.5], [-0.5, 17.5]], 2, 2)
    array([[0. , 0.2],
           [0.4, 1. ]])
    """
    stack: Array = as_stack(np.asarray(image)[None])
    number = patch_of(stack.shape[1:3], corners, rows, columns, **knobs)
    shown = number >= 0
    counts = np.bincount(number[shown], minlength=rows * columns)
    if not counts.all():
        raise ValueError(
            f"expected patches of a few pixels at least, {np.sum(counts == 0)} hold none: check the corners"
        )
    pixels = stack[0].reshape(*number.shape, -1)[shown].astype(np.float64)
    sums = [np.bincount(number[shown], one, rows * columns) for one in pixels.T]
    M = np.stack(sums, axis=-1) / counts[:, None] / (levels(stack) - 1)
    return M.reshape(rows, columns, *stack.shape[3:])
