"""Radiometric self-calibration (Mitsunaga and Nayar, CVPR 1999).

M       brightness     (C, N, P), 0 ... 1: sample p in frame q, frames from short to long, channel by channel
f_inv   f^-1           M -> exposure, a polynomial of order N with f^-1(0) = 0 and f^-1(1) = 1
b_n     basis          M (1 - M) T_n(2 M - 1), n = 0 ... N - 2, with T_n the Chebyshev polynomials
c       coefficients   (C, N - 1), one row a channel
R       ratios         (P - 1,), exposure of frame q over that of frame q + 1: one shutter for all channels
H       (N, N)         eq. 7 multiplied out: the sum of squares is (1, c) H (1, c)^T

A sample in two neighboring frames gives the equation f^-1(M_q) = R f^-1(M_q+1) [eq. 5]. If R is
known, that is linear in c; if c is known, R is a quotient. So each is computed from the other in
turn, starting from rough ratios. But (f^-u, R^u) solves eq. 5 as well as (f^-1, R) does: along u the
error is a nearly level valley, which noise tilts one way or the other. The first iterations lead
into the valley, all later ones along it: mostly toward the truth, sometimes far away from it. So
`eps` does more than end the iteration: it keeps the result near the ratios given.

f^-1(M) = M + sum_n c_n b_n(M): this form holds every polynomial through both ends and no other. So
eq. 8 needs no equation of its own, and c = 0 is the linear camera. The powers M^n of eq. 3 are so
similar that at N = 10 their normal equations lose all digits. And a ratio is a quotient of sums,
not a mean of quotients [eq. 10, which lacks its 1/P], to which dark pixels would add mostly noise.

Three more things differ from the paper. It leaves c_0 free; here f^-1(0) = 0, no exposure without
light. It uses all samples; here both frames must measure a sample between `MIN_BRIGHTNESS` and
`MAX_BRIGHTNESS`. It fits each channel by itself; here all channels share the ratios. The paper
names the functions the other way round: its f is f^-1 here, and its g is the response.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebvander

from hdrlab.core.arrays import F64, ArrayLike, Indices, Mask
from hdrlab.errors import InputError

# fraction of the trace of H: where the samples constrain less, f^-1 stays a straight line
RIDGE_FRACTION = 1e-7
# A frame measures a sample well if its brightness lies between these.
MIN_BRIGHTNESS = 0.05
MAX_BRIGHTNESS = 0.98
# `recover` takes an even grid of about this many pixels.
_GRID_PIXELS = 12_000


class Fit(NamedTuple):
    """After an iteration: c (C, N - 1), the ratios R (P - 1,) for it, and the change of f^-1."""

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
    >>> value([0, 0.5, 1], []).tolist()  # without coefficients it is a straight line
    [0.0, 0.5, 1.0]
    """
    return np.asarray(terms(M, np.size(c) + 1) @ np.append(1, c))


def in_range(M: F64) -> Mask:
    """Return (..., P - 1), whether frames q and q + 1 both measure a sample well; NaN counts as not.

    Examples
    --------
    >>> in_range(np.array([0.1, 0.4, 0.99])).tolist()  # the third frame is clipped
    [True, False]
    """
    inside = (M > MIN_BRIGHTNESS) & (M < MAX_BRIGHTNESS)
    return inside[..., :-1] & inside[..., 1:]


def neighbours(M: F64, order: int) -> tuple[F64, F64, Indices]:
    """Return the terms a and b (K, N) of samples M (N, P) in frames q (K,) and q + 1, and q.

    Only pairs that both frames measure well are kept.
    """
    used = in_range(M)
    phi = terms(np.nan_to_num(M), order)
    a = phi[:, :-1][used]
    b = phi[:, 1:][used]
    q = np.nonzero(used)[1]
    return a, b, q


def gram(a: F64, b: F64, q: Indices, R: F64) -> F64:
    """Return H of sum (f^-1(M_q) - R_q f^-1(M_q+1))^2 = (1, c) H (1, c)^T [eq. 7]."""
    D = a - R[q, None] * b
    return D.T @ D


def coefficients(H: F64) -> F64:
    """Return the c that minimizes (1, c) H (1, c)^T, where its derivative is 0 [eq. 9]."""
    ridge = (RIDGE_FRACTION * np.trace(H) + 1e-300) * np.eye(len(H) - 1)
    return np.linalg.solve(H[1:, 1:] + ridge, -H[1:, 0])


def ratios(channels: Sequence[tuple[F64, F64, Indices]], c: F64, R: F64) -> F64:
    """Return sum f^-1(M_q) / sum f^-1(M_q+1) of each pair [eq. 10]; R where no sample constrains it."""
    dark = np.zeros(len(R))
    bright = np.zeros(len(R))
    for (a, b, q), c_channel in zip(channels, c, strict=True):
        dark += np.bincount(q, a[:, 0] + a[:, 1:] @ c_channel, len(R))
        bright += np.bincount(q, b[:, 0] + b[:, 1:] @ c_channel, len(R))
    return np.divide(dark, bright, out=R.copy(), where=(dark > 0) & (dark < bright))


def fit_steps(
    M: F64, R: F64, order: int, *, eps: float = 1e-3, max_iterations: int = 30
) -> Iterator[Fit]:
    """Yield c and R after each iteration, until f^-1 changes by less than eps [eq. 11]."""
    channels = [neighbours(M_channel, order) for M_channel in M]
    basis = terms(np.linspace(0, 1, 256), order)[:, 1:]
    R = np.asarray(R)
    before = np.full(256, np.inf)
    for _ in range(max_iterations):
        c = np.stack([coefficients(gram(a, b, q, R)) for a, b, q in channels])
        R = ratios(channels, c, R)
        curves = c @ basis.T
        change = float(np.max(np.abs(curves - before)))
        before = curves
        yield Fit(c, R, change)
        if change < eps:
            return


def curve(c: ArrayLike, n: int = 256, *, least: float = 1e-4) -> F64:
    """Return g = ln f^-1 (n,), g[n // 2] = 0, where f^-1 rises by at least `least` / (n - 1) a level.

    A polynomial may dip where no pixel constrains it, and a g that falls has no inverse. The clamp
    acts on the increments, so that the curve keeps its shape wherever it rises. Level 0 holds all
    light below half a level, and is placed in the middle of that.
    """
    increments = np.maximum(np.diff(value(np.linspace(0, 1, n), c)), least / (n - 1))
    first = increments[0] / 4
    second = 0.75 * increments[0]
    f_inv = np.cumsum([first, second, *increments[1:]])
    return np.log(f_inv / f_inv[n // 2])


def recover(images: ArrayLike, times: ArrayLike, *, order: int = 5, eps: float = 1e-3) -> F64:
    """Return the response g of a bracket whose exposure times are only roughly known.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Photographs, aligned.
    times : (P,) float
        Exposure times in seconds, at least two different ones. Errors of 10 % are partly corrected.
    order : int
        Order of the polynomial.
    eps : float
        Stop when f^-1, 0 to 1, changes by less than this. With a smaller eps the ratios drift
        further from the times.

    Returns
    -------
    (256,) or (256, 3) float64
        g, the ln exposure of each level, rising; g[128] = 0 in every channel.

    Raises
    ------
    ValueError
        For photographs and times that do not fit together, and for photographs without pixels that
        two neighboring frames measure well.

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
    images = np.asarray(images)
    t = np.asarray(times, np.float64)
    is_stack = images.ndim >= 3 and images.shape[3:] in ((), (3,)) and images.size > 0
    if not is_stack or images.dtype.kind != "u":
        raise InputError(f"expected photographs (P, H, W[, 3]), got {images.dtype} {images.shape}")
    if t.shape != images.shape[:1] or not np.all((t > 0) & (t < np.inf)):
        raise InputError(f"expected {len(images)} positive times in seconds, got {t}")
    images = images[np.argsort(t)]
    t = np.sort(t)
    step = max(1, int(np.sqrt(images.size / len(t) / _GRID_PIXELS)))
    grid = images[:, ::step, ::step].reshape(len(t), -1, images[0, 0, 0].size)
    M = grid.T / np.iinfo(images.dtype).max
    if not np.all(in_range(M).any(axis=(1, 2))):
        low = MIN_BRIGHTNESS
        high = MAX_BRIGHTNESS
        raise InputError(
            f"expected pixels between {low} and {high} of the top level in two neighboring frames"
        )
    for fit in fit_steps(M, t[:-1] / t[1:], order, eps=eps):
        c = fit.c
    g = np.stack([curve(c_channel) for c_channel in c], axis=-1)
    return g.reshape(256, *images.shape[3:])
