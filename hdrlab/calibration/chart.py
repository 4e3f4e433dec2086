"""Calibration with a chart of 24 patches (Mitsunaga and Nayar, 1999, fig. 6; Wilburn et al., 2008, sec. 5).

corners  (4, 2) pixels (x, y)   of the corner patches, outside: top left, top right, bottom right, bottom left
u, v     grid coordinates       a patch is 1 wide: column k begins at u = k (1 + gap), and so for rows and v
H        homography (3, 3)      (u, v, 1) -> (x, y, 1) times a factor
R        reflectance (6,)       of the bottom row, white to black: the share of light that a patch reflects
M        brightness             (4, 6[, 3]) of the patches, 0 to 1
t        exposure times         (P,) seconds
X        exposure               R times the light; of one patch in many photographs, t times what it reflects

A homography maps a plane to its photograph by a camera without distortion, and four corners
determine its eight parameters. One photograph gives six points of the inverse response, as the
reflectances of the gray patches are known. Several photographs with different times need no
reflectances: the exposure of a patch is proportional to time, which is a blend with a scale and
without an offset. `joining` finds the scales and one curve: Wilburn's ground truth.

The reflectances are the specification of the chart, McCamy, Marcus and Davidson, A color-rendition
chart, 1976, as the package colour-science lists it ("ColorChecker 1976"). Printed charts differ:
BabelColor's mean of 30 is 1.4 % above it for white, 3.3 % below for neutral 5, and 2.2 % above for
black. Pass your own R if you have measured your chart.
"""

from pathlib import Path

import numpy as np
from scipy.interpolate import PchipInterpolator

from hdrlab.calibration import blends, joining
from hdrlab.core.arrays import F64, ArrayLike, as_stack, as_times, describe, levels
from hdrlab.core.filters import warp
from hdrlab.core.optional import skimage_draw
from hdrlab.errors import InputError

ROWS = 4
COLUMNS = 6
# between the patches of the classic chart, over a patch's width
GAP = 0.15
# Y of the patches in %, row by row, under illuminant C
LUMINANCE = np.loadtxt(Path(__file__).with_name("colorchecker.csv"), delimiter=",")
LUMINANCE.setflags(write=False)
# R of the gray patches, the same for every channel, as gray reflects all wavelengths equally
NEUTRAL = LUMINANCE[3] / 100
UNIT_SQUARE = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])


def homography(source: ArrayLike, target: ArrayLike) -> F64:
    """Return H (3, 3), H[2, 2] = 1, that takes the four corners `source` (4, 2) to `target` (4, 2).

    Raises
    ------
    ValueError
        For points that are not the corners of a convex quadrilateral.

    Examples
    --------
    >>> homography(UNIT_SQUARE, [[5, 5], [7, 5], [7, 7], [5, 7]]).round(9) + 0.0
    array([[2., 0., 5.],
           [0., 2., 5.],
           [0., 0., 1.]])
    """
    return warp.through(_as_corners(source), _as_corners(target))


def _as_corners(points: ArrayLike) -> F64:
    """Return the points (4, 2) if they are the corners of a convex quadrilateral, or raise a ValueError."""
    corners = np.asarray(points, np.float64)
    if corners.shape != (4, 2) or not np.all(np.isfinite(corners)):
        raise InputError(f"expected four corners (4, 2), (x, y) in pixels, got {describe(corners)}")
    edges = np.roll(corners, -1, axis=0) - corners
    turns = np.linalg.det(np.stack([edges, np.roll(edges, -1, axis=0)], axis=1))
    turn_the_same_way = abs(np.sign(turns).sum()) == 4
    if not turn_the_same_way or np.abs(turns).min() < 1e-6 * np.ptp(corners) ** 2:
        raise InputError(f"expected the corners of a convex quadrilateral, got {corners.tolist()}")
    return corners


def read_patches(
    image: ArrayLike,
    corners: ArrayLike,
    rows: int,
    columns: int,
    *,
    gap: float = 0.0,
    core: float = 0.6,
) -> F64:
    """Return the mean brightness of each patch's core, 0 to 1, in any grid of patches.

    Parameters
    ----------
    image : (H, W) or (H, W, 3) uint8 or uint16
        A photograph of the grid.
    corners : (4, 2)
        Pixels (x, y), outer corners of the corner patches: top left, top right, bottom right,
        bottom left as the grid counts them, however the photograph is turned.
    rows, columns : int
        Of the grid.
    gap : float
        Space between two patches, over a patch's width.
    core : float
        The fraction of a patch's width and height that is read; the rest is mixed by edges and the
        lens.

    Returns
    -------
    (rows, columns) or (rows, columns, 3) float64

    Raises
    ------
    ValueError
        For arrays that are no image or no corners, corners outside of the image, or patches too
        small to hold a pixel.

    Examples
    --------
    >>> image = np.kron([[0, 51], [102, 255]], np.ones((9, 9))).astype(np.uint8)
    >>> read_patches(image, [[-0.5, -0.5], [17.5, -0.5], [17.5, 17.5], [-0.5, 17.5]], 2, 2)
    array([[0. , 0.2],
           [0.4, 1. ]])
    """
    stack = as_stack(np.asarray(image)[None])
    if rows < 1 or columns < 1 or not gap >= 0 or not 0 < core <= 1:
        raise InputError(f"expected {rows=}, {columns=} > 0, {gap=} >= 0 and 0 < {core=} <= 1")
    width = columns + gap * (columns - 1)
    height = rows + gap * (rows - 1)
    H = homography(UNIT_SQUARE * [width, height], corners)
    shape = np.array(stack.shape[1:3])
    if np.any(np.asarray(corners) < -0.5) or np.any(np.asarray(corners) > shape[::-1] - 0.5):
        raise InputError(
            f"expected corners within a picture of {shape} pixels, got {describe(corners)}"
        )
    M = np.empty((rows, columns, *stack.shape[3:]))
    for row, column in np.ndindex(rows, columns):
        core_corners = np.array([column, row]) * (1 + gap) + 0.5 + core * (UNIT_SQUARE - 0.5)
        x, y, w = H @ np.vstack([core_corners.T, np.ones(4)])
        pixels = stack[0][skimage_draw.polygon(y / w, x / w, shape)]
        if len(pixels) == 0:
            raise InputError(
                "expected patches of several pixels, but one contains none; check the corners"
            )
        M[row, column] = pixels.mean(axis=0) / (levels(stack) - 1)
    return M


def read_chart(image: ArrayLike, corners: ArrayLike, *, gap: float = GAP, core: float = 0.6) -> F64:
    """Return M (4, 6[, 3]), the mean brightness of the chart's patches, dark skin first and black last.

    Parameters
    ----------
    image : (H, W) or (H, W, 3) uint8 or uint16
        A photograph of the chart, evenly lit.
    corners : (4, 2)
        Pixels (x, y): the outer corners of dark skin, bluish green, black and white, in this order;
        so a chart that stands on its head or lies on its side is read as well.
    gap : float
        Space between two patches over a patch's width.
    core : float
        The fraction of a patch's width and height that is read.

    Raises
    ------
    ValueError
        As `read_patches`.

    Examples
    --------
    >>> chart = np.kron(LUMINANCE * 2.5, np.ones((20, 20))).astype(np.uint8)
    >>> M = read_chart(chart, [[-0.5, -0.5], [119.5, -0.5], [119.5, 79.5], [-0.5, 79.5]], gap=0)
    >>> bool(np.allclose(M[3], np.floor(NEUTRAL * 250) / 255))
    True
    """
    return read_patches(image, corners, ROWS, COLUMNS, gap=gap, core=core)


def recover_gray(M: ArrayLike, R: ArrayLike = NEUTRAL) -> blends.InverseResponse:
    """Return the inverse response through the gray patches, interpolated so that it rises (PCHIP).

    Parameters
    ----------
    M : (K,) float
        Brightness of the patches in one channel, 0 to 1.
    R : (K,) float
        Their reflectances: those of the specification, or better the chart's own.

    Returns
    -------
    InverseResponse
        From the darkest patch measured to the brightest; s is what reflectance 1 has, r what none
        has, so that `blends.ln_exposure(joined, black=joined.r[0])` is g for every merge.

    Raises
    ------
    ValueError
        For fewer than three patches measured, or ones whose brightness does not rise with their
        reflectance.

    Examples
    --------
    >>> joined = recover_gray(0.9 * NEUTRAL ** 0.5)
    >>> true = (joined.M / 0.9) ** 2  # a camera with f = 0.9 root
    >>> bool(np.abs(joined.X - (true - true[0]) / (true[-1] - true[0])).max() < 0.01)
    True
    """
    M = np.asarray(M, np.float64)
    R = np.asarray(R, np.float64)
    samples = blends.make_blend(R, M)
    order = np.argsort(samples.I)
    x = samples.I[order]
    m = samples.M[order]
    if len(x) < 3:
        raise InputError(
            f"expected three gray patches in the measured range, got {len(x)} of {describe(M)}"
        )
    if np.any(np.diff(x) <= 0) or np.any(np.diff(m) <= 0):
        raise InputError(
            f"expected brighter patches for higher reflectance, got {m.round(4).tolist()}"
        )
    brightness = np.linspace(m[0], m[-1], blends.TABLE_SIZE)
    exposure = PchipInterpolator(m, x)(brightness)
    return blends.normalize(brightness, exposure, s=np.ones(1), r=np.zeros(1))


def recover_bracket(M: ArrayLike, times: ArrayLike) -> blends.InverseResponse:
    """Return the inverse response that patches photographed with several times join in [Wilburn08 sec. 5].

    Parameters
    ----------
    M : (P, K) float
        Brightness of K patches in P photographs, one channel, 0 to 1. The patches may be coloured.
    times : (P,) float
        Seconds.

    Returns
    -------
    InverseResponse
        s is each patch's exposure per second; r is the X without any light.

    Raises
    ------
    ValueError
        For arrays that do not fit together, or no patch measured at three times.

    Examples
    --------
    >>> times = 2.0 ** np.arange(-6, 1, 0.5)
    >>> M = np.minimum(np.outer(times, NEUTRAL), 1) ** (1 / 2.2)
    >>> joined = recover_bracket(M, times)
    >>> bool(np.allclose(joined.s / joined.s[0], NEUTRAL / NEUTRAL[0], rtol=0.01))
    True
    """
    M = np.asarray(M, np.float64)
    if M.ndim != 2:
        raise InputError(
            f"expected brightness (P, K) of K patches in P photographs, got {describe(M)}"
        )
    times = as_times(times, len(M))
    return joining.join([blends.make_blend(times, patch) for patch in M.T], offset=False)


def read_bracket(
    images: ArrayLike, corners: ArrayLike, *, gap: float = GAP, core: float = 0.6
) -> F64:
    """Return M (P, 24[, 3]) of photos (P, H, W[, 3]) from one place; see `read_chart`."""
    charts = [read_chart(image, corners, gap=gap, core=core) for image in as_stack(images)]
    M = np.stack(charts)
    return M.reshape(len(M), ROWS * COLUMNS, *M.shape[3:])
