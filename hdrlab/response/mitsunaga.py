"""Radiometric self-calibration (Mitsunaga and Nayar, CVPR 1999).

M    brightness     (C, N, P), 0 ... 1: sample p in frame q, frames from short to long, channel by channel
f    polynomial     M -> exposure, f(0) = 0, f(1) = 1: see `polynomial`
c    coefficients   (C, order - 1), one row a channel
R    ratios         (P - 1,), exposure of frame q over that of frame q + 1: one shutter for all channels
m    moments        sums over the samples: see `pairs`
E    error          what eq. 7 minimises: sum (f(M_q) - R f(M_q+1))^2

A sample in two neighbouring frames says f(M_q) = R f(M_q+1) [eq. 5]. With R known that is linear in c; with c
known, R is a quotient; so take turns, from rough ratios. But (f^u, R^u) answers eq. 5 as well as (f, R) does:
along u the error is a valley, nearly level, which noise tilts one way or the other. The first turns lead into
the valley, all later ones along it: mostly towards the truth, now and then far away. So `eps` is more than a
stop, it keeps the answer near the ratios given: it bounds the worst case, where a typical one would gain from
more turns. `ambiguity` shows the slide; `marginal` has an estimator that knows how noise tilts the valley.

Departures: samples are means of many pixels, used where both frames hold them in 0.05 ... 0.98; f(0) = 0; and
a ratio is a quotient of sums, not a mean of quotients [eq. 10, which lacks its 1/P], to which dark pixels add
mostly noise. And the order is the least that other parts of the picture ask for, see `choose_order`; that of
least error [sec. 4] is the highest.
"""

from collections.abc import Iterator, Sequence
from functools import reduce
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core.arrays import as_mask, as_stack, as_times
from hdrlab.core.bracket import short_to_long
from hdrlab.core.sampling import by_grid
from hdrlab.core.steps import last
from hdrlab.response.pairs import HIGHEST, Moments, average, both, held, moments
from hdrlab.response.polynomial import basis, curve, misfit

Float = NDArray[np.float64]
RIDGE = 1e-7  # of the mean square of M and f: where the samples tell less, the straight line is kept
PARTS, STRIPES = 5, 20  # of the picture, for the choice of the order: a part is every fifth stripe
FINEST = 0.01 / 255  # in brightness, a hundredth of a level: what is less is no difference
SWINGS = basis(np.linspace(0, 1, 256), HIGHEST)  # how each coefficient moves f at the pixel levels


class State(NamedTuple):
    """One turn: c (C, order - 1), the R (P - 1,) they lead to, the error both leave, and how far f moved."""

    c: Float
    R: Float
    error: float
    change: float


def quadratic(m: Moments, R: Float) -> Float:
    """Return H (C, N, N) of E = (1, c) H (1, c)^T, the square of eq. 7 multiplied out."""
    R = R[:, None, None]
    return (m.aa - R * (m.ab + m.ab.swapaxes(-1, -2)) + R**2 * m.bb).sum(axis=1)


def coefficients(m: Moments, R: Float, order: int) -> Float:
    """Return c (C, order - 1) of dE / dc = 0 [eq. 9]; eq. 8 is built into the basis."""
    H = quadratic(m, R)[:, :order, :order]
    A, b = H[:, 1:, 1:], -H[:, 1:, :1]
    ridge = RIDGE * np.trace(H, axis1=1, axis2=2) + 1e-300
    return np.asarray(np.linalg.solve(A + ridge[:, None, None] * np.eye(order - 1), b)[..., 0])


def ratios(m: Moments, c: Float, R: Float) -> Float:
    """Return sum f(M_q) / sum f(M_q+1) of each pair [eq. 10]; the ratio before where no sample tells."""
    f = np.column_stack([np.ones(len(c)), c])[:, None]
    n = f.shape[-1]
    above, below = (f * m.a[..., :n]).sum(axis=(0, 2)), (f * m.b[..., :n]).sum(axis=(0, 2))
    told = (above > 0) & (above < below)
    return np.where(told, above / np.where(told, below, 1), R)


def error(m: Moments, R: Float, c: Float) -> float:
    """Return the root mean square of f(M_q) - R f(M_q+1) over samples, pairs and channels [eq. 7]."""
    f = np.column_stack([np.ones(len(c)), c])
    n = f.shape[-1]
    E = np.einsum("ci,cij,cj->", f, quadratic(m, R)[:, :n, :n], f)
    return float(np.sqrt(max(E, 0) / m.samples.sum()))


def fit_steps(m: Moments, R: ArrayLike, order: int, *, eps: float = 1e-3, most: int = 30) -> Iterator[State]:
    """Yield the State after each turn, c and then R, until no f(M) moves by eps any more [eq. 11]."""
    R, before = np.asarray(R, dtype=np.float64), None
    for _ in range(most):
        c = coefficients(m, R, order)
        R = ratios(m, c, R)
        change = (
            np.inf
            if before is None
            else float(np.abs(SWINGS[:, : order - 1] @ (c - before).T).max(initial=0))
        )
        yield State(c, R, error(m, R, c), change)
        if change < eps:
            return
        before = c


def fit(m: Moments, R: ArrayLike, order: int, **knobs: float) -> State:
    """Return the last State of `fit_steps`."""
    return last(fit_steps(m, R, order, **knobs))  # type: ignore[arg-type]


def others(parts: Sequence[Float]) -> list[Moments]:
    """Return the Moments of all parts of the picture but one, for each of them."""
    m = [moments(M) for M in parts]
    return [reduce(both, m[:k] + m[k + 1 :]) for k in range(len(m))]


def held_out(parts: Sequence[Float], R: Float, order: int, without: Sequence[Moments] | None = None) -> Float:
    """Return the error (K,) of each part of the picture under the c of the `others`, rms in brightness.

    Not that of eq. 7, which is small wherever f is flat, and high orders make it so. And R stays as stated: a
    straight line explains a power law as well as the power does, with ratios of its own.
    """
    found = np.zeros(len(parts))
    for k, (M, m) in enumerate(zip(parts, without or others(parts), strict=True)):
        c, used = coefficients(m, R, order), held(M)
        left = misfit(M[..., :-1], M[..., 1:], R, c)
        found[k] = np.sqrt(np.mean(left[used] ** 2)) if used.any() else 0
    return found


def choose_order(parts: Sequence[Float], R: ArrayLike) -> int:
    """Return the least order whose held-out error is within a standard error of the best [Breiman84 3.4.3].

    One for all channels, from samples M (C, N, P) of each part of a picture. Halves of samples that each hold
    pixels from all over it would not do: what motion and flare add stands in both, and they confirm it.
    """
    if len(parts) < 2:
        return 1
    R = np.asarray(R, dtype=np.float64)
    without = others(parts)
    errors = np.stack([held_out(parts, R, order, without) for order in range(1, HIGHEST + 1)])
    mean = errors.mean(axis=1)
    best = int(np.argmin(mean))
    doubt = np.std(errors[best], ddof=1) / np.sqrt(len(parts))
    return 1 + int(np.argmax(mean <= mean[best] + max(doubt, FINEST)))


def calibrate(
    images: ArrayLike,
    times: ArrayLike,
    *,
    order: int | None = None,
    eps: float = 1e-3,
    pixels: int = 12_000,
    samples: int = 400,
    valid: ArrayLike | None = None,
) -> State:
    """Return the last State for a bracket: the coefficients and the ratios. Parameters as of `recover`."""
    parts, R = averages(images, times, pixels=pixels, samples=samples, valid=valid)
    m = reduce(both, [moments(M) for M in parts])
    if not np.all(m.samples.sum(axis=1)):
        raise ValueError(
            "expected pixels between 0.05 and 0.98 of the top level in two neighbouring frames; got none"
        )
    return fit(m, R, choose_order(parts, R) if order is None else order, eps=eps)


def averages(
    images: ArrayLike, times: ArrayLike, *, pixels: int, samples: int, valid: ArrayLike | None
) -> tuple[list[Float], Float]:
    """Return samples of a bracket, from short to long, and the ratios R (P - 1,) of its times.

    The samples come in PARTS of the picture, M (C, N, P) each: every PARTS-th of its STRIPES.
    """
    stack = as_stack(images)
    times = as_times(times, len(stack), distinct=2)
    by_time = short_to_long(stack, times)
    Z = by_grid(stack, pixels, valid=as_mask(valid, stack))[:, by_time]
    Z = np.moveaxis(Z.reshape(*Z.shape[:2], -1), -1, 0)
    stripes = np.array_split(np.arange(Z.shape[1]), STRIPES)  # the grid's pixels come row by row
    parts = [Z[:, np.concatenate(stripes[k::PARTS])] for k in range(min(PARTS, Z.shape[1]))]
    each = -(-samples // PARTS)
    M = [np.stack([average(one, each) for one in part]) for part in parts]
    return M, times[by_time][:-1] / times[by_time][1:]


def exposure_ratios(images: ArrayLike, times: ArrayLike, **knobs: Any) -> Float:
    """Return R (P - 1,), each frame's exposure over the next longer one's. Parameters as of `recover`."""
    return calibrate(images, times, **knobs).R


def recover(images: ArrayLike, times: ArrayLike, *, valid: ArrayLike | None = None, **knobs: Any) -> Float:
    """Return the response g, and take the exposure times for rough.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Photographs, aligned; 16 bits are read at 256 levels.
    times : (P,) float
        Exposure times in seconds, at least two different ones. Errors of a tenth are corrected in part;
        `exposure_ratios` tells to what.
    order : int, optional
        Of the polynomial; by default the least of 1 to 10 whose held-out error is within a standard error of
        the best.
    eps : float
        Stop when f, 0 to 1, moves by less. A smaller one lets the ratios drift further from the times.
    pixels, samples : int
        How many pixels to take, on an even grid, and how many means to make of them.
    valid : (P, H, W) bool, optional
        False where a photograph holds no picture.

    Returns
    -------
    (256,) or (256, 3) float64
        g, the ln exposure of each level, rising; g[128] = 0 in every channel.

    Raises
    ------
    ValueError
        For fewer than two photographs or two times, and photographs that share no levels worth using.

    References
    ----------
    Mitsunaga and Nayar, Radiometric self calibration, CVPR 1999. For the standard error, Breiman, Friedman,
    Olshen and Stone, Classification and regression trees, 1984, sec. 3.4.3.

    Examples
    --------
    >>> ramp = np.linspace(1, 100, 10_000).reshape(100, 100)  # a linear camera
    >>> images = np.clip(np.round(ramp * np.array([1, 2, 4])[:, None, None]), 0, 255).astype(np.uint8)
    >>> g = recover(images, [0.01, 0.02, 0.04])
    >>> bool(abs(g[200] - np.log(200 / 128)) < 0.01)
    True
    """
    g = np.stack([curve(c) for c in calibrate(images, times, valid=valid, **knobs).c], axis=-1)
    return g.reshape(256, *np.shape(images)[3:])
