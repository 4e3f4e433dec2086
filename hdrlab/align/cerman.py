"""Registration by correlation and simplex (Cerman and Hlavac, Computer Vision Winter Workshop 2006).

X       light               (2, h, w): a fixed and a moving photograph on one scale, see `light`
s       shift (dy, dx)      pixels, where the moving photograph's middle must go, down and right
phi     rotation            about the middle, clockwise as seen
r       radius              from the middle to a corner, pixels: the unknowns are (dy, dx, r phi), all pixels
H       homography          (3, 3): the same, where pixel (x, y, 1) of `moving` lies on `fixed`
e       error               mean square of the difference relative to the light, see `light`

A pyramid makes it fast: the correlation is taken at the coarsest level, and the simplex starts each
level from what the one above found. Neighbours in exposure are registered, and their homographies
chained.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import scipy

from hdrlab.align import light
from hdrlab.core.arrays import F32, F64, ArrayLike, Indices
from hdrlab.core.filters import warp

# of the correlation: the coarsest level tries this many
PEAKS = 3
# of the error, at most, on each level
CALLS = 120


class State(NamedTuple):
    """One level of one pair, the coarsest first; level 0 is full resolution.

    `path` (n, 3) has the best corner of the simplex after each of its steps, (dy, dx, r phi) in
    pixels of this level, and `errors` (n,) what it comes to; `H` is where it ended, in pixels of
    this level.
    """

    level: int
    X: F32
    path: F64
    errors: F64
    H: F64


def correlation(X: F32) -> F64:
    """Return how well `moving` fits at every shift (dy, dx): the sum of a(p + s) b(p), by FFT.

    Discarded pixels are 0, and so is the mean, or the brightest overlap would win: the mean around
    each pixel, for light that falls off slowly across the scene would win, too.
    """
    a, b = (np.where(np.isfinite(x), x - light.local_mean(x), 0) for x in X)
    h, w = X.shape[1:]
    size = [scipy.fft.next_fast_len(2 * n - 1) for n in (h, w)]
    c = scipy.fft.irfft2(scipy.fft.rfft2(a, size) * np.conj(scipy.fft.rfft2(b, size)), size)
    return np.asarray(np.roll(c, (h - 1, w - 1), axis=(0, 1))[: 2 * h - 1, : 2 * w - 1])


def peaks(c: F64, count: int) -> Indices:
    """Return the shifts (count, 2) of the highest peaks, the highest first: argmax [Cerman06 eq. 5]."""
    y, x = np.nonzero((c == scipy.ndimage.maximum_filter(c, 5)) & (c > 0))
    best = np.argsort(-c[y, x], kind="stable")[:count]
    return np.stack([y[best], x[best]], axis=-1) - np.array(c.shape) // 2


def rigid(shape: tuple[int, ...], unknowns: ArrayLike) -> F64:
    """Return H of (dy, dx, r phi)."""
    dy, dx, arc = np.asarray(unknowns, float)
    return warp.turn(shape, np.rad2deg(2 * arc / np.hypot(shape[0], shape[1])), (dy, dx))


def descend(X: F32, start: ArrayLike, reach: float, close: float = 0.01) -> tuple[F64, F64]:
    """Return the path (n, 3) of a simplex that begins `reach`, ends `close` pixels wide, and its errors."""
    shape, p = X.shape[1:], light.lattice(X.shape[1:])
    found: dict[tuple[float, ...], float] = {}

    def e(unknowns: F64) -> float:
        found[tuple(unknowns)] = light.error(light.differences(X, rigid(shape, unknowns), p))
        return found[tuple(unknowns)]

    corners = np.asarray(start, float) + reach * np.vstack([np.zeros(3), np.eye(3)])
    options = {
        "initial_simplex": corners,
        "xatol": close,
        "fatol": 1e-9,
        "maxfev": CALLS,
        "return_all": True,
    }
    path = np.array(
        scipy.optimize.minimize(e, start, method="Nelder-Mead", options=options).allvecs
    )
    return path, np.array([found[tuple(unknowns)] for unknowns in path])


def search(pyramid: list[F32]) -> Iterator[State]:
    """Yield a State per level: the correlation's best peaks at the coarsest, then the simplex at each."""
    starts = [(*shift, 0.0) for shift in peaks(correlation(pyramid[-1]), PEAKS)] or [
        (0.0, 0.0, 0.0)
    ]
    reach = 2.0
    for level in reversed(range(len(pyramid))):
        X, close = pyramid[level], 0.05 if level else 0.01  # of a pixel
        path, errors = min(
            (descend(X, one, reach, close) for one in starts), key=lambda found: found[1][-1]
        )
        starts, reach = [2 * path[-1]], 1.0
        yield State(level, X.copy(), path, errors, rigid(X.shape[1:], path[-1]))


def align_steps(images: ArrayLike, times: ArrayLike, g: ArrayLike) -> Iterator[State]:
    """Yield the States of pair after pair of neighbours in exposure, from dark to bright."""
    for pyramid in light.neighbours(images, times, g):
        yield from search(pyramid)


def align(images: ArrayLike, times: ArrayLike, g: ArrayLike) -> F64:
    """Return the homographies that lay every image on the one in the middle of their exposure.

    They turn and shift. Each image is compared with its neighbours in exposure in linear light, and
    the homographies are chained; `resample.photographs` moves the images.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3), uint8 or uint16
        Photographs of one scene with different exposures, in any order.
    times : (P,) seconds
        Their exposures; `light.exposure_ratio` measures ratios by the histograms.
    g : (n,) or (n, 3)
        The camera's response, ln exposure of each level. It can be found from photographs that are
        not aligned, by their histograms: `debevec.recover` does.

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
