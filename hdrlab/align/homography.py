"""Registration by distinct points and a homography (Tomaszewska and Mantiuk, WSCG 2007).

A homography takes shift, rotation, scale and tilt at once, as of a camera that was carried a step.

X   light                 (2, h, w): a fixed and a moving photograph on one scale, see `light`
D   detail                (h, w) in [0, 1]: the logarithm of light over the mean around it, 1/2 where unknown
q   matches               (n, 2), (x, y): points of the moving photograph, and of the fixed one
H   homography            (3, 3): where pixel (x, y, 1) of the moving photograph lies on the fixed one
c   corners               (4, 2): where H puts the corners, pixels; the unknowns of the last stage
d   differences           see `light`

Points are found and described by scikit-image's SIFT, and their homography by its RANSAC, on a
small level. Then the corners are moved until the light fits, level by level: e as in `cerman`, by
least squares, for a simplex is slow in eight dimensions.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import scipy

from hdrlab.align import light
from hdrlab.core.arrays import F32, F64, ArrayLike, Mask
from hdrlab.core.filters import warp
from hdrlab.core.optional import skimage_feature, skimage_measure, skimage_transform as transform

# pixels of the level where points are looked for, at most
PIXELS = 250_000
# points of a photograph, the largest: every one is compared with every other
MOST = 3000
# pixels of that level, between a match and its homography
INLIER = 1.5
# matches that agree: 4 make a homography out of nothing
ENOUGH = 10
# samples of four matches
TRIES = 2000


class State(NamedTuple):
    """One level of one pair; first that of the points, then down to full resolution, level 0.

    X is the light of both images, H in pixels of this level, e its error. `points` (2, n, 2) are
    the matches of the first level, of the moving image and of the fixed one, `agree` (n,) those
    that H explains.
    """

    level: int
    X: F32
    points: F64
    agree: Mask
    H: F64
    e: float


def detail(x: F32) -> F64:
    """Return D of the light x (h, w): a range of 8 to 1 around the mean fills it."""
    over = np.log2(x / light.local_mean(x), where=x > 0, out=np.zeros(x.shape))
    return np.clip(np.where(np.isfinite(over), over, 0) / 6 + 0.5, 0, 1)


def match_points(X: F32) -> F64:
    """Return the matches (2, n, 2), (x, y), of `moving` and of `fixed`: alike, and nothing else as alike."""
    found = []
    for x in (X[1], X[0]):
        sift = skimage_feature.SIFT()
        try:
            sift.detect_and_extract(detail(x))
        except RuntimeError:  # scikit-image's word for no point at all
            return np.empty((2, 0, 2))
        largest = np.argsort(-np.asarray(sift.sigmas), kind="stable")[:MOST]
        points, descriptors = np.asarray(sift.keypoints), np.asarray(sift.descriptors)
        found.append((points[largest, ::-1].astype(float), descriptors[largest]))
    (q, one), (p, other) = found
    both = skimage_feature.match_descriptors(one, other, max_ratio=0.8, cross_check=True)
    return np.stack([q[both[:, 0]], p[both[:, 1]]])


def consensus(points: F64) -> tuple[F64, Mask]:
    """Return the H that most matches agree with, and which [Fischler and Bolles 1981]; else the identity."""
    if points.shape[1] < ENOUGH:
        return np.eye(3), np.zeros(points.shape[1], bool)
    homography = transform.ProjectiveTransform
    model, agree = skimage_measure.ransac(
        tuple(points), homography, 4, INLIER, max_trials=TRIES, rng=np.random.default_rng(0)
    )
    if model is None or agree is None or agree.sum() < ENOUGH:
        return np.eye(3), np.zeros(points.shape[1], bool)
    return np.asarray(model.params / model.params[2, 2]), agree


def refine(X: F32, H: F64) -> F64:
    """Return H with its corners moved to where the sum of d^2 is least; what lies far out counts little."""
    corners, p = warp.corners(X.shape[1:]), light.lattice(X.shape[1:])
    start = warp.apply(H, corners)

    def d(c: F64) -> F64:
        moved = warp.through(corners, start + c.reshape(4, 2))
        return np.nan_to_num(light.differences(X, moved, p), nan=0.0)

    options = {"loss": "soft_l1", "f_scale": 0.1, "diff_step": 0.1, "x_scale": 1.0, "max_nfev": 12}
    found = scipy.optimize.least_squares(d, np.zeros(8), **options)
    better = warp.through(corners, start + found.x.reshape(4, 2))
    return min((H, better), key=lambda one: light.error(light.differences(X, one, p)))


def enlarge(H: F64, times: float = 2) -> F64:
    """Return H in finer pixels: pixel x of a level lies over 2 x + 1/2 of the one that is twice as large."""
    finer = np.array([[times, 0, (times - 1) / 2], [0, times, (times - 1) / 2], [0, 0, 1]])
    return np.asarray(finer @ H @ np.linalg.inv(finer))


def search(pyramid: list[F32]) -> Iterator[State]:
    """Yield a State per level: points and consensus at the first, then light at each."""
    small = next(j for j, X in enumerate(pyramid) if X[0].size <= PIXELS or j == len(pyramid) - 1)
    for first in (
        small,
        max(small - 1, 0),
    ):  # twice the size has more points, and takes four times as long
        points = match_points(pyramid[first])
        H, agree = consensus(points)
        if agree.any():
            break
    for level in range(first, -1, -1):
        X = pyramid[level]
        if agree.any():
            H = refine(X, H)
        e = light.error(light.differences(X, H, light.lattice(X.shape[1:])))
        yield State(level, X.copy(), points.copy(), agree.copy(), H.copy(), e)
        H = enlarge(H)


def align_steps(images: ArrayLike, times: ArrayLike, g: ArrayLike) -> Iterator[State]:
    """Yield the States of pair after pair of neighbours in exposure, from dark to bright."""
    for pyramid in light.neighbours(images, times, g):
        yield from search(pyramid)


def align(images: ArrayLike, times: ArrayLike, g: ArrayLike) -> F64:
    """Return the homographies that lay every image on the one in the middle of their exposure.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3), uint8 or uint16
        Photographs of one scene with different exposures, in any order.
    times : (P,) seconds
        Their exposures.
    g : (n,) or (n, 3)
        The camera's response, ln exposure of each level.

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
    Tomaszewska and Mantiuk, "Image Registration for Multi-exposure High Dynamic Range Image
    Acquisition", WSCG 2007. Lowe, "Distinctive Image Features from Scale-Invariant Keypoints", IJCV
    60(2), 2004.

    Examples
    --------
    >>> from hdrlab import scenes
    >>> from hdrlab.capture import camera, hand_motion, responses
    >>> room = scenes.room((220, 320))
    >>> tilted = hand_motion.shake(2, room.shape, radius=12, degrees=4, zoom=0.05, tilt=0.05, rng=7)
    >>> taken = camera.shoot(room, [0.01, 0.04], offsets=tilted)
    >>> H = align(taken.images, taken.times, responses.true_g())
    >>> truth = hand_motion.frame_homographies(tilted, room.shape)
    >>> bool(warp.corner_distance(H[0], truth[0], room.shape) < 1)  # pixels
    True
    """
    steps = [state.H for state in align_steps(images, times, g) if state.level == 0]
    return warp.chain_homographies(np.argsort(times, kind="stable"), steps)
