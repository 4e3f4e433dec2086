"""Registration by correlation and simplex (Cerman and Hlavac, Computer Vision Winter Workshop 2006).

X       light               (2, h, w): a fixed and a moving photograph on one scale, see `light`
s       shift (dy, dx)      pixels, where the moving photograph's middle must go, down and right
phi     rotation            about the middle, clockwise as seen
r       radius              from the middle to a corner, pixels: the unknowns are (dy, dx, r phi), all pixels
H       (3, 3)              the same as a homography: where pixel (x, y, 1) of `moving` lies on `fixed`
n       normaliser          max(mean of the two values, t): a difference counts relative to the light
e       error               mean of ((a - b) / n)^2 over the pixels that both show

A pyramid makes it fast: the correlation is taken at the coarsest level, and the simplex starts each level
from what the one above found. Neighbours in brightness are registered, and their moves chained.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import minimize

from hdrlab.align import light
from hdrlab.align.criterion import differences, error, lattice
from hdrlab.align.matches import Match, Pair, along, correlation, judge, neighbours, peaks
from hdrlab.core import warp
from hdrlab.core.steps import last

Float = NDArray[np.float64]
PEAKS = 3  # of the correlation: the coarsest level tries so many
CALLS = 120  # of the error, at most, on each level


class State(NamedTuple):
    """One level of one pair, the coarsest first; level 0 is full resolution.

    Image `moving` is laid on image `fixed`; X is their light. `path` (n, 3) has the best corner of the
    simplex after each of its steps, (dy, dx, r phi) in pixels of this level, and `errors` (n,) what it comes
    to; `H` is where it ended, in pixels of this level.
    """

    moving: int
    fixed: int
    level: int
    X: light.Float
    path: Float
    errors: Float
    H: Float


def radius(shape: tuple[int, ...]) -> float:
    """Return r."""
    return float(np.hypot(shape[0], shape[1]) / 2)


def rigid(shape: tuple[int, ...], unknowns: ArrayLike) -> Float:
    """Return H of (dy, dx, r phi)."""
    dy, dx, arc = np.asarray(unknowns, float)
    return warp.turn(shape, np.rad2deg(arc / radius(shape)), (dy, dx))


def descend(X: light.Float, start: ArrayLike, reach: float, close: float = 0.01) -> tuple[Float, Float]:
    """Return the path (n, 3) of a simplex that begins `reach`, ends `close` pixels wide, and its errors."""
    shape, p = X.shape[1:], lattice(X.shape[1:])
    told: dict[tuple[float, ...], float] = {}

    def e(unknowns: Float) -> float:
        return told.setdefault(tuple(unknowns), error(differences(X, rigid(shape, unknowns), p)))

    options = {
        "initial_simplex": np.asarray(start, float) + reach * np.vstack([np.zeros(3), np.eye(3)]),
        "xatol": close,
        "fatol": 1e-9,
        "maxfev": CALLS,
        "return_all": True,
    }
    path = np.array(minimize(e, start, method="Nelder-Mead", options=options).allvecs)
    return path, np.array([told[tuple(one)] for one in path])


def search(pair: Pair) -> Iterator[State]:
    """Yield a State per level: the correlation's best peaks at the coarsest, then the simplex at each."""
    X = pair.X[-1]
    starts = [(*shift, 0.0) for shift in peaks(correlation(X), PEAKS)] or [(0.0, 0.0, 0.0)]
    reach = 2.0
    for level in reversed(range(len(pair.X))):
        X, close = pair.X[level], 0.05 if level else 0.01  # of a pixel
        tries = [descend(X, start, reach, close) for start in starts]
        path, errors = min(tries, key=lambda found: found[1][-1])
        starts, reach = [2 * path[-1]], 1.0
        yield State(*pair[:2], level, X.copy(), path, errors, rigid(X.shape[1:], path[-1]))


def align_steps(
    images: ArrayLike | Sequence[ArrayLike],
    *,
    times: ArrayLike | None = None,
    g: ArrayLike | None = None,
) -> Iterator[State]:
    """Yield the States of pair after pair, from dark to bright."""
    for pair in neighbours(images, times, g):
        yield from search(pair)


def verdicts(
    images: ArrayLike | Sequence[ArrayLike],
    *,
    times: ArrayLike | None = None,
    g: ArrayLike | None = None,
) -> tuple[Match, ...]:
    """Return the Match of every pair of neighbours in brightness, from dark to bright; knobs of `align`."""
    return tuple(judge(pair, last(search(pair)).H) for pair in neighbours(images, times, g))


def align(
    images: ArrayLike | Sequence[ArrayLike],
    *,
    times: ArrayLike | None = None,
    g: ArrayLike | None = None,
) -> Float:
    """Return the moves that lay every image on the one in the middle of their brightness, turned and shifted.

    Each image is compared with its neighbours in brightness in linear light, and the moves are chained. A
    pair's move counts only where the photographs then agree clearly better than without. `verdicts` tells
    which pairs to doubt; `matches.along` chains them; `resample.photographs` moves the images.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3), uint8 or uint16
        Photographs of one scene with different exposures, in any order.
    times : (P,) seconds, optional
        Their exposures. Without them the ratios come out of the histograms.
    g : (n,) or (n, 3), optional
        The camera's response, ln exposure of each level. It can be found from photographs that are not
        aligned, by their histograms: `debevec.recover` does. Without it the histograms of each pair are
        matched, which is less exact.

    Returns
    -------
    moves : (P, 3, 3)
        Where pixel (x, y, 1) of each image lies on the one in the middle, whose move is the identity.

    Raises
    ------
    ValueError
        For images that are not a stack of photographs, and for times or a response that do not fit them.

    References
    ----------
    Cerman and Hlavac, "Exposure Time Estimation for High Dynamic Range Imaging with Hand Held Camera",
    Computer Vision Winter Workshop 2006.

    Examples
    --------
    >>> from hdrlab.capture import camera, hand_motion, responses, scenes
    >>> room = scenes.room((150, 220))
    >>> turned = warp.turn(room.shape, 1.5, (4.3, -2.6))
    >>> taken = camera.shoot(room, [0.02, 0.08], offsets=[turned, np.eye(3)])
    >>> moves = align(taken.images, times=taken.times, g=responses.true_g())
    >>> truth = hand_motion.frame_homographies([turned, np.eye(3)], room.shape)
    >>> bool(warp.apart(moves[0], truth[0], room.shape) < 0.3)  # pixels at the corners
    True
    """
    return along(verdicts(images, times=times, g=g))
