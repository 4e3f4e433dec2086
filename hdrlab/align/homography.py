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
from dataclasses import dataclass

import numpy as np
import scipy

from hdrlab.align import light
from hdrlab.core.arrays import F32, F64, Array, ArrayLike, Mask
from hdrlab.core.filters import warp
from hdrlab.core.optional import skimage_feature, skimage_measure, skimage_transform as transform

# Every point of a photograph is compared with every point of the other: only the largest are used.
MAX_POINTS = 3000
# scikit-image finds no points in smaller photographs, and raises an IndexError.
MIN_SIDE_PIXELS = 6
# A match agrees with a homography that puts it at most this far off, in pixels of its level.
MAX_INLIER_DISTANCE_PIXELS = 1.5
# Any four matches fit a homography; with this many that agree it is no coincidence.
MIN_AGREEING_MATCHES = 10
# Points are looked for at the finest level that has at most this many pixels.
_MAX_POINT_LEVEL_PIXELS = 250_000
# RANSAC draws this many samples of four matches.
_RANSAC_TRIALS = 2000
# The corners are refined in at most this many evaluations.
_MAX_REFINEMENTS = 12
# The detail of a picture spans this many stops around its local mean.
_DETAIL_STOPS = 6


@dataclass(frozen=True, kw_only=True, eq=False)
class State:
    """One level of one pair: first the level of the points, then down to full resolution, level 0.

    Attributes
    ----------
    level : number of times that the photographs were halved
    X : (2, h, w) light of both photographs at this level
    points : (2, n, 2) matches at the first level, (x, y) in the moving photograph and the fixed one
    agree : (n,) whether a match agrees with the homography
    H : (3, 3) homography in pixels of this level
    e : its error
    """

    level: int
    X: F32
    points: F64
    agree: Mask
    H: F64
    e: float


def detail(x: F32) -> F64:
    """Return D of the light x (h, w): a range from 1/8 to 8 times the local mean fills 0 to 1."""
    stops = np.log2(x / light.local_mean(x), where=x > 0, out=np.zeros(x.shape))
    return np.clip(np.where(np.isfinite(stops), stops, 0) / _DETAIL_STOPS + 0.5, 0, 1)


def find_points(x: F32, max_points: int = MAX_POINTS) -> tuple[F64, Array]:
    """Return the points (n, 2), (x, y), of a photograph, the largest first, and their descriptors."""
    if min(x.shape) < MIN_SIDE_PIXELS:
        return np.empty((0, 2)), np.empty((0, 128))
    sift = skimage_feature.SIFT()
    try:
        sift.detect_and_extract(detail(x))
    except RuntimeError:  # scikit-image raises it where there is no point at all
        return np.empty((0, 2)), np.empty((0, 128))
    largest = np.argsort(-np.asarray(sift.sigmas), kind="stable")[:max_points]
    points = np.asarray(sift.keypoints)[largest, ::-1].astype(float)
    return points, np.asarray(sift.descriptors)[largest]


def match_points(X: F32, max_points: int = MAX_POINTS) -> F64:
    """Return the matches (2, n, 2), (x, y), of `moving` and of `fixed`.

    Two points match if each is the most similar one to the other, and clearly more similar than the
    second.
    """
    q, q_descriptors = find_points(X[1], max_points)
    if not len(q):
        return np.empty((2, 0, 2))
    p, p_descriptors = find_points(X[0], max_points)
    if not len(p):
        return np.empty((2, 0, 2))
    matches = skimage_feature.match_descriptors(
        q_descriptors, p_descriptors, max_ratio=0.8, cross_check=True
    )
    return np.stack([q[matches[:, 0]], p[matches[:, 1]]])


def consensus(points: F64) -> tuple[F64, Mask]:
    """Return the H that most matches agree with, by RANSAC, and which of them do (n,).

    Where too few agree it is the identity, and no match counts as agreeing [Fischler and Bolles
    1981].
    """
    nothing = np.eye(3), np.zeros(points.shape[1], bool)
    if points.shape[1] < MIN_AGREEING_MATCHES:
        return nothing
    model, agree = skimage_measure.ransac(
        tuple(points),
        transform.ProjectiveTransform,
        min_samples=4,
        residual_threshold=MAX_INLIER_DISTANCE_PIXELS,
        max_trials=_RANSAC_TRIALS,
        rng=np.random.default_rng(0),
    )
    if model is None or agree is None or agree.sum() < MIN_AGREEING_MATCHES:
        return nothing
    return np.asarray(model.params / model.params[2, 2]), agree


def refine(X: F32, H: F64) -> F64:
    """Return H with its corners moved to where the sum of d^2 is least; outliers count little."""
    corners = warp.corners(X.shape[1:])
    p = light.lattice(X.shape[1:])
    start = warp.apply(H, corners)

    def d(c: F64) -> F64:
        moved = warp.through(corners, start + c.reshape(4, 2))
        return np.nan_to_num(light.differences(X, moved, p), nan=0.0)

    result = scipy.optimize.least_squares(
        d,
        np.zeros(8),
        loss="soft_l1",
        f_scale=0.1,
        diff_step=0.1,
        x_scale=1.0,
        max_nfev=_MAX_REFINEMENTS,
    )
    better = warp.through(corners, start + result.x.reshape(4, 2))
    e_before = light.error(light.differences(X, H, p))
    e_after = light.error(light.differences(X, better, p))
    return better if e_after < e_before else H


def enlarge(H: F64, times: float = 2) -> F64:
    """Return H in the pixels of a level that is `times` as large.

    Pixel x of a level lies over 2 x + 1/2 of the level that is twice as large.
    """
    middle = (times - 1) / 2
    finer = np.array([[times, 0, middle], [0, times, middle], [0, 0, 1]])
    return np.asarray(finer @ H @ np.linalg.inv(finer))


def search(pyramid: list[F32]) -> Iterator[State]:
    """Yield a State per level: points and consensus at the first one, then light at each."""
    small = 0
    while pyramid[small][0].size > _MAX_POINT_LEVEL_PIXELS and small < len(pyramid) - 1:
        small += 1
    # The next finer level has more points, but takes four times as long.
    for first in (small, max(small - 1, 0)):
        points = match_points(pyramid[first])
        H, agree = consensus(points)
        if agree.any():
            break
    for level in range(first, -1, -1):
        X = pyramid[level]
        if agree.any():
            H = refine(X, H)
        e = light.error(light.differences(X, H, light.lattice(X.shape[1:])))
        yield State(
            level=level, X=X.copy(), points=points.copy(), agree=agree.copy(), H=H.copy(), e=e
        )
        H = enlarge(H)


def align_steps(images: ArrayLike, times: ArrayLike, g: ArrayLike) -> Iterator[State]:
    """Yield the States of pair after pair of neighbours in exposure, from dark to bright."""
    for pyramid in light.neighbours(images, times, g):
        yield from search(pyramid)


def align(images: ArrayLike, times: ArrayLike, g: ArrayLike) -> F64:
    """Return the homographies that align every image with the one of the middle exposure.

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
