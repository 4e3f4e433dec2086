"""Radiometric self-calibration (Mitsunaga and Nayar, CVPR 1999).

M       brightness     (C, N, P), 0 ... 1: sample p in frame q, frames from short to long, channel by channel
f_inv   f^-1           M -> exposure, a polynomial of order N with f^-1(0) = 0 and f^-1(1) = 1
b_n     basis          M (1 - M) T_n(2 M - 1), n = 0 ... N - 2, with T_n the Chebyshev polynomials
c       coefficients   (C, N - 1), one row a channel
R       ratios         (P - 1,), exposure of frame q over that of frame q + 1: one shutter for all channels
H       (N, N)         eq. 7 multiplied out: the sum of squares is (1, c) H (1, c)^T

A sample in two neighbouring frames says f^-1(M_q) = R f^-1(M_q+1) [eq. 5]. With R known that is
linear in c; with c known, R is a quotient; so each is made from the other, from rough ratios on.
But (f^-u, R^u) answers eq. 5 as well as (f^-1, R) does: along u the error is a valley, nearly
level, which noise tilts one way or the other. The first iterations lead into the valley, all later
ones along it: mostly towards the truth, now and then far away. So `eps` is more than a stop, it
keeps the answer near the ratios given.

f^-1(M) = M + sum_n c_n b_n(M): every polynomial through both ends can be written so, and no other
can, so eq. 8 needs no equation of its own, and c = 0 is the linear camera. The powers M^n of eq. 3
are so alike that at N = 10 their normal equations lose all digits. And a ratio is a quotient of
sums, not a mean of quotients [eq. 10, which lacks its 1/P], to which dark pixels add mostly noise.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebvander

from hdrlab.core.arrays import F64, ArrayLike, Indices, Mask
from hdrlab.errors import InputError

# of the trace of H: where the samples constrain less, the straight line is kept
RIDGE = 1e-7
# brightness of a sample that both frames see well
LOW, HIGH = 0.05, 0.98


class Fit(NamedTuple):
    """After an iteration: c (C, N - 1), the R (P - 1,) they lead to, and by how much f^-1 changed."""

    c: F64
    R: F64
    change: float


def terms(M: ArrayLike, order: int) -> F64:
    """Return (M, b_0(M), ..., b_N-2(M)), (..., N), whose sum with (1, c) is f^-1(M)."""
    M = np.asarray(M, np.float64)[..., None]
    T = chebvander(2 * M[..., 0] - 1, order)[..., : order - 1]
    return np.concatenate([M, M * (1 - M) * T], axis=-1)


def value(M: ArrayLike, c: ArrayLike) -> F64:
    """Return f^-1(M) = M + sum_n c_n b_n(M) [Mitsunaga99 eq. 3].

    Examples
    --------
    >>> value([0, 0.5, 1], []).tolist()  # with no terms a straight line
    [0.0, 0.5, 1.0]
    """
    return np.asarray(terms(M, np.size(c) + 1) @ np.append(1, c))


def in_range(M: F64) -> Mask:
    """Return (..., P - 1), whether both of two neighbouring frames see a sample well; NaN is not seen.

    Examples
    --------
    >>> in_range(np.array([0.1, 0.4, 0.99])).tolist()  # the third frame is clipped
    [True, False]
    """
    inside = (M > LOW) & (M < HIGH)
    return inside[..., :-1] & inside[..., 1:]


def neighbours(M: F64, order: int) -> tuple[F64, F64, Indices]:
    """Return the terms a, b (K, N) of samples M (N, P) that frames q (K,) and q + 1 see well."""
    used, phi = in_range(M), terms(np.nan_to_num(M), order)
    return phi[:, :-1][used], phi[:, 1:][used], np.nonzero(used)[1]


def gram(a: F64, b: F64, q: Indices, R: F64) -> F64:
    """Return H of sum (f^-1(M_q) - R_q f^-1(M_q+1))^2 = (1, c) H (1, c)^T [eq. 7]."""
    D = a - R[q, None] * b
    return D.T @ D


def coefficients(H: F64) -> F64:
    """Return c of the least (1, c) H (1, c)^T, where its derivative is 0 [eq. 9]."""
    ridge = (RIDGE * np.trace(H) + 1e-300) * np.eye(len(H) - 1)
    return np.linalg.solve(H[1:, 1:] + ridge, -H[1:, 0])


def ratios(channels: Sequence[tuple[F64, F64, Indices]], c: F64, R: F64) -> F64:
    """Return sum f^-1(M_q) / sum f^-1(M_q+1) of each pair [eq. 10]; R where no sample constrains it."""
    total = np.zeros((2, len(R)))
    for (a, b, q), own in zip(channels, c, strict=True):
        total += [np.bincount(q, phi[:, 0] + phi[:, 1:] @ own, len(R)) for phi in (a, b)]
    return np.divide(total[0], total[1], out=R.copy(), where=(total[0] > 0) & (total[0] < total[1]))


def fit_steps(
    M: F64, R: F64, order: int, *, eps: float = 1e-3, max_iterations: int = 30
) -> Iterator[Fit]:
    """Yield c and R after each iteration, until f^-1 changes by less than eps [eq. 11]."""
    channels = [neighbours(own, order) for own in M]
    levels, R, before = (
        terms(np.linspace(0, 1, 256), order)[:, 1:],
        np.asarray(R),
        np.full(256, np.inf),
    )
    for _ in range(max_iterations):
        c = np.stack([coefficients(gram(*one, R)) for one in channels])
        R = ratios(channels, c, R)
        curves = c @ levels.T
        change, before = float(np.max(np.abs(curves - before))), curves
        yield Fit(c, R, change)
        if change < eps:
            return


def curve(c: ArrayLike, n: int = 256, *, least: float = 1e-4) -> F64:
    """Return g = ln f^-1 (n,), g[n // 2] = 0, where f^-1 climbs by `least` / (n - 1) or more a level.

    A polynomial may dip where no pixel held it; a g that falls has no inverse. The clamp acts on
    the increments, so the curve keeps its shape wherever it rises. Level 0 holds what is darker
    than half a level; it gets the middle of that.
    """
    increments = np.maximum(np.diff(value(np.linspace(0, 1, n), c)), least / (n - 1))
    f_inv = np.cumsum(np.append(increments[0] / 4, [0.75 * increments[0], *increments[1:]]))
    return np.log(f_inv / f_inv[n // 2])


def recover(images: ArrayLike, times: ArrayLike, *, order: int = 5, eps: float = 1e-3) -> F64:
    """Return the response g, and take the exposure times for rough.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Photographs, aligned.
    times : (P,) float
        Exposure times in seconds, at least two different ones. Errors of a tenth are corrected in
        part.
    order : int
        Of the polynomial.
    eps : float
        Stop when f^-1, 0 to 1, changes by less. A smaller one lets the ratios drift further from
        the times.

    Returns
    -------
    (256,) or (256, 3) float64
        g, the ln exposure of each level, rising; g[128] = 0 in every channel.

    Raises
    ------
    ValueError
        For photographs and times that do not fit, or photographs that share no levels worth using.

    References
    ----------
    Mitsunaga and Nayar, Radiometric self calibration, CVPR 1999.

    Examples
    --------
    >>> ramp = np.linspace(1, 100, 10_000).reshape(100, 100)  # a linear camera
    >>> images = np.clip(np.round(ramp * np.array([1, 2, 4])[:, None, None]), 0, 255).astype(np.uint8)
    >>> g = recover(images, [0.01, 0.02, 0.04])
    >>> bool(abs(g[200] - np.log(200 / 128)) < 0.01)
    True
    """
    images, t = np.asarray(images), np.asarray(times, np.float64)
    if (
        images.dtype.kind != "u"
        or images.ndim < 3
        or images.shape[3:] not in ((), (3,))
        or not images.size
    ):
        raise InputError(f"expected photographs (P, H, W[, 3]), got {images.dtype} {images.shape}")
    if t.shape != images.shape[:1] or not np.all((t > 0) & (t < np.inf)):
        raise InputError(f"expected {len(images)} positive times in seconds, got {t}")
    images, t = images[np.argsort(t)], np.sort(t)
    every = max(
        1, int(np.sqrt(images.size / len(t) / 12_000))
    )  # an even grid of some thousand pixels
    M = (
        images[:, ::every, ::every].reshape(len(t), -1, images[0, 0, 0].size).T
        / np.iinfo(images.dtype).max
    )
    if not all(in_range(own).any() for own in M):
        raise InputError(
            "expected pixels between 0.05 and 0.98 of the top level in two neighbouring frames"
        )
    *_, state = fit_steps(M, t[:-1] / t[1:], order, eps=eps)
    return np.stack([curve(c) for c in state.c], axis=-1).reshape(256, *images.shape[3:])
