"""Registration by correlation and simplex (Cerman and Hlavac, Computer Vision Winter Workshop 2006).

X       light               (2, h, w): a fixed and a moving photograph on one scale, see `light`
s       shift (dy, dx)      pixels, where the moving photograph's middle must go, down and right
phi     rotation            about the middle, clockwise as seen
r       radius              from the middle to a corner, pixels: the unknowns are (dy, dx, r phi), all pixels
H       homography          (3, 3): the same, where pixel (x, y, 1) of `moving` lies on `fixed`
e       error               mean square of the difference relative to the light, see `light`

Neighbours in exposure are registered, and their homographies chained, as in the paper. A pyramid,
which the paper does not have, makes it fast: the correlation is taken at the coarsest level, and
the simplex starts each level from what the one above found. The paper takes the maximum of the
correlation of the light itself [eq. 5, which prints max for argmax]; here local means are
subtracted first, and the simplex starts from several peaks.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy

from hdrlab.align import light
from hdrlab.core.arrays import F32, F64, ArrayLike, Indices
from hdrlab.core.filters import warp

# The coarsest level starts a simplex from this many peaks of the correlation.
_MAX_PEAKS = 3
# A simplex that has evaluated the error this often stops where it is.
_MAX_EVALUATIONS = 120
# A peak of the correlation is the largest value in a square of this many pixels a side.
_PEAK_WINDOW_PIXELS = 5
# size of the first simplex, in pixels: at the coarsest level, and at all finer ones
_COARSEST_SIMPLEX_PIXELS = 2.0
_FINER_SIMPLEX_PIXELS = 1.0
# size of the simplex at which a level ends, in pixels of that level
_COARSE_TOLERANCE_PIXELS = 0.05
_FINEST_TOLERANCE_PIXELS = 0.01


@dataclass(frozen=True, kw_only=True, eq=False)
class State:
    """One level of one pair, the coarsest first; level 0 is full resolution.

    Attributes
    ----------
    level : number of times that the photographs were halved
    X : (2, h, w) light of both photographs at this level
    path : (n, 3) best corner of the simplex after each step, (dy, dx, r phi) in pixels of this
        level
    errors : (n,) error at each point of the path
    H : (3, 3) homography at the end of the path, in pixels of this level
    """

    level: int
    X: F32
    path: F64
    errors: F64
    H: F64


def correlation(X: F32) -> F64:
    """Return how well `moving` fits at every shift (dy, dx): the sum of a(p + s) b(p), by FFT.

    Discarded pixels are 0. The mean is subtracted, or the brightest overlap would win. It is the
    mean around each pixel, because light that falls off slowly across the scene would win, too.
    """
    a, b = [np.where(np.isfinite(x), x - light.local_mean(x), 0) for x in X]
    h, w = X.shape[1:]
    size = [scipy.fft.next_fast_len(2 * n - 1) for n in (h, w)]
    spectrum = scipy.fft.rfft2(a, size) * np.conj(scipy.fft.rfft2(b, size))
    c = scipy.fft.irfft2(spectrum, size)
    return np.asarray(np.roll(c, (h - 1, w - 1), axis=(0, 1))[: 2 * h - 1, : 2 * w - 1])


def peaks(c: F64, count: int) -> Indices:
    """Return the shifts (count, 2) of the highest peaks, the highest first [Cerman06 eq. 5]."""
    is_peak = c == scipy.ndimage.maximum_filter(c, _PEAK_WINDOW_PIXELS)
    y, x = np.nonzero(is_peak & (c > 0))
    best = np.argsort(-c[y, x], kind="stable")[:count]
    return np.stack([y[best], x[best]], axis=-1) - np.array(c.shape) // 2


def rigid(shape: tuple[int, ...], unknowns: ArrayLike) -> F64:
    """Return the homography H of a shift and a rotation, (dy, dx, r phi)."""
    dy, dx, arc = np.asarray(unknowns, float)
    r = np.hypot(shape[0], shape[1]) / 2
    return warp.turn(shape, np.rad2deg(arc / r), (dy, dx))


def descend(
    X: F32, start: ArrayLike, reach: float, close: float = _FINEST_TOLERANCE_PIXELS
) -> tuple[F64, F64]:
    """Minimize the error by a simplex; return its path (n, 3) and the errors (n,) along it.

    The simplex is `reach` pixels wide at first, and ends when it is `close` pixels wide.
    """
    shape = X.shape[1:]
    p = light.lattice(shape)
    errors: dict[tuple[float, ...], float] = {}

    def e(unknowns: F64) -> float:
        error = light.error(light.differences(X, rigid(shape, unknowns), p))
        errors[tuple(unknowns)] = error
        return error

    corners = np.asarray(start, float) + reach * np.vstack([np.zeros(3), np.eye(3)])
    options = {
        "initial_simplex": corners,
        "xatol": close,
        "fatol": 1e-9,
        "maxfev": _MAX_EVALUATIONS,
        "return_all": True,
    }
    result = scipy.optimize.minimize(e, start, method="Nelder-Mead", options=options)
    path = np.array(result.allvecs)
    return path, np.array([errors[tuple(unknowns)] for unknowns in path])


def refine(X: F32, start: ArrayLike, *, reach: float = _FINER_SIMPLEX_PIXELS) -> F64:
    """Return the motion (dy, dx, r phi) with the smallest error near `start`, by a simplex."""
    path, _ = descend(X, start, reach)
    return path[-1]


def search(pyramid: list[F32]) -> Iterator[State]:
    """Yield a State per level: peaks of the correlation at the coarsest, then a simplex at each."""
    shifts = peaks(correlation(pyramid[-1]), _MAX_PEAKS)
    starts: list[ArrayLike] = [(*shift, 0.0) for shift in shifts] or [(0.0, 0.0, 0.0)]
    reach = _COARSEST_SIMPLEX_PIXELS
    for level in reversed(range(len(pyramid))):
        X = pyramid[level]
        close = _COARSE_TOLERANCE_PIXELS if level else _FINEST_TOLERANCE_PIXELS
        descents = [descend(X, start, reach, close) for start in starts]
        path, errors = min(descents, key=lambda descent: descent[1][-1])
        H = rigid(X.shape[1:], path[-1])
        starts = [2 * path[-1]]
        yield State(level=level, X=X.copy(), path=path, errors=errors, H=H)
        reach = _FINER_SIMPLEX_PIXELS


def align_steps(images: ArrayLike, times: ArrayLike, g: ArrayLike) -> Iterator[State]:
    """Yield the States of pair after pair of neighbours in exposure, from dark to bright."""
    for pyramid in light.neighbours(images, times, g):
        yield from search(pyramid)


def align(images: ArrayLike, times: ArrayLike, g: ArrayLike) -> F64:
    """Return the homographies that align every image with the one of the middle exposure.

    They turn and shift. Each image is compared with its neighbors in exposure in linear light, and
    the homographies are chained. `resample.photographs` moves the images.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3), uint8 or uint16
        Photographs of one scene with different exposures, in any order.
    times : (P,) seconds
        Their exposures; `light.exposure_ratio` estimates their ratios from the histograms.
    g : (n,) or (n, 3)
        The camera's response, ln exposure of each level. `debevec.recover` finds it from
        photographs that are not aligned, by their histograms.

    Returns
    -------
    homographies : (P, 3, 3)
        Where pixel (x, y, 1) of each image lies on the one in the middle, whose own is the
        identity.

    Raises
    ------
    ValueError
        For images that are not a stack of photographs, and for times that do not fit them.

    References
    ----------
    Cerman and Hlavac, "Exposure Time Estimation for High Dynamic Range Imaging with Hand Held
    Camera", Computer Vision Winter Workshop 2006.

    Examples
    --------
    >>> from hdrlab import scenes
    >>> from hdrlab.capture import camera, hand_motion, responses
    >>> room = scenes.room((150, 220))
    >>> turned = warp.turn(room.shape, 1.5, (4.3, -2.6))
    >>> taken = camera.shoot(room, [0.02, 0.08], offsets=[turned, np.eye(3)])
    >>> H = align(taken.images, taken.times, responses.true_g())
    >>> truth = hand_motion.frame_homographies([turned, np.eye(3)], room.shape)
    >>> bool(warp.corner_distance(H[0], truth[0], room.shape) < 0.3)  # pixels
    True
    """
    steps = [state.H for state in align_steps(images, times, g) if state.level == 0]
    return warp.chain_homographies(np.argsort(times, kind="stable"), steps)
