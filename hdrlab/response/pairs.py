"""What pairs of neighbouring frames hold for a polynomial response: averages, pairs, and sums over them.

Z    pixel levels   (N, P) integers, 0 ... 255
M    brightness     (N, P), 0 ... 1, means over groups of pixels; NaN where the group is clipped
phi  columns        (M, b_0(M), b_1(M), ...), so that f(M) = phi . (1, c): see `polynomial`

Least squares asks of the samples only sums of products, and eq. 10 only sums: the moments of phi. Once they
are taken, a turn of the scheme costs as much for a million samples as for ten; and as the orders are nested,
one set of moments serves all.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core.arrays import describe
from hdrlab.response.polynomial import basis

Float = NDArray[np.float64]
HIGHEST = 10  # order that is tried
SOME = 0.1  # of a group: fewer clipped members hardly move its mean, and near the top there are always a few


class Moments(NamedTuple):
    """Sums over the samples of each pair of frames.

    aa, ab, bb (C, P - 1, N, N) of the products of phi(M_q), phi(M_q+1); a, b (C, P - 1, N) of them alone;
    samples (C, P - 1), how many.
    """

    aa: Float
    ab: Float
    bb: Float
    a: Float
    b: Float
    samples: NDArray[np.intp]


def average(Z: ArrayLike, count: int = 80) -> Float:
    """Return M (count, P), means of groups of pixels Z (N, P) that are alike; NaN where some are clipped.

    Alike: near in the mean over the frames. Sorted by one frame's values, they would be sorted by its noise.
    """
    Z = np.asarray(Z)
    if (
        Z.ndim != 2
        or Z.dtype.kind not in "iu"
        or Z.shape[1] < 2
        or len(Z) == 0
        or Z.min() < 0
        or Z.max() > 255
    ):
        raise ValueError(f"expected levels 0 to 255, Z (N, P) of at least two frames, got {describe(Z)}")
    frames = np.ascontiguousarray(Z.T, dtype=np.uint8)
    key = 256 * frames.sum(axis=0, dtype=np.uint32) // len(frames)
    frames = frames[:, np.argsort(key.astype(np.uint16), kind="stable")]  # 16 bits are sorted by counting
    starts = np.linspace(0, len(Z), min(count, len(Z)), endpoint=False).astype(int)
    members = np.diff(np.append(starts, len(Z)))
    clipped = np.add.reduceat((frames == 0) | (frames == 255), starts, axis=1, dtype=int)
    M = np.add.reduceat(frames, starts, axis=1, dtype=float) / (255 * members)
    return np.where(clipped > SOME * members, np.nan, M).T


def held(M: Float, *, low: float = 0.05, high: float = 0.98) -> NDArray[np.bool_]:
    """Return (..., P - 1), whether both of two neighbouring frames hold a sample, between low and high.

    Examples
    --------
    >>> held(np.array([0.1, 0.4, 0.99])).tolist()  # the third frame is clipped
    [True, False]
    """
    inside = (M > low) & (M < high)  # NaN is not
    return inside[..., :-1] & inside[..., 1:]


def moments(M: Float, order: int = HIGHEST, **cuts: float) -> Moments:
    """Return the Moments of samples M (C, N, P), of those that both frames of a pair hold."""
    used = held(M, **cuts)
    M = np.nan_to_num(M)
    phi = np.concatenate([M[..., None], basis(M, order)], axis=-1)
    A, B = (np.where(used[..., None], one, 0).swapaxes(1, 2) for one in (phi[:, :, :-1], phi[:, :, 1:]))
    At, Bt = A.swapaxes(-1, -2), B.swapaxes(-1, -2)
    return Moments(At @ A, At @ B, Bt @ B, A.sum(axis=2), B.sum(axis=2), used.sum(axis=1))


def both(first: Moments, second: Moments) -> Moments:
    """Return the Moments of two sets of samples together."""
    return Moments._make(a + b for a, b in zip(first, second, strict=True))
