"""Why self-calibration drifts: the u-ambiguity (Mitsunaga and Nayar, CVPR 1999, sec. 4 and 5).

M  brightness     (N, P) or, of two frames, (N, 2)
f  polynomial     M -> exposure, f(0) = 0, f(1) = 1; c its coefficients: see `polynomial`
R  ratios         (P - 1,), exposure of a frame over that of the next longer one
u  exponent       (f^u, R^u) answers f(M_q) = R f(M_q+1) whatever u is; u = 1 is the truth

The experiments of the paper: cameras and pictures drawn at random, its scheme as one writes it down from the
page, what becomes of that when it is not stopped, and the error along R seen as a whole.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.response.mitsunaga import coefficients, gram, in_range, neighbours, value
from hdrlab.response.polynomial import brightness, misfit, random
from hdrlab.response.self_calibration import average

Float = NDArray[np.float64]


class Trial(NamedTuple):
    """A camera drawn at random and what it saw: c (order - 1,), R (P - 1,), pixel levels Z (N, P)."""

    c: Float
    R: Float
    Z: NDArray[np.intp]


class Drift(NamedTuple):
    """The literal scheme, turn by turn (K,): rms of eq. 7, u, means of |f - truth| and |f - truth^u|."""

    error: Float
    u: Float
    off: Float
    off_power: Float


class Valley(NamedTuple):
    """Figure 4: the error (K,) at ratios R (K,), where it has local minima, and the ratio a search finds."""

    R: Float
    error: Float
    minima: Float
    found: float


def trial(
    rng: np.random.Generator,
    *,
    order: int = 5,
    ratios: ArrayLike | None = None,
    pixels: int = 10_000,
    decades: float = 2.0,
    sigma: float = 0.005,
) -> Trial:
    """Return a trial of [Mitsunaga99 sec. 5]: a random rising curve, four frames, noise, 256 levels.

    The paper leaves the distributions open. Here: ratios uniform in 0.45 ... 0.55; radiance uniform in its
    logarithm, `decades` wide, the brightest just filling the longest exposure; the curve as
    `polynomial.random` draws it.
    """
    c = random(rng, order=order)
    R = rng.uniform(0.45, 0.55, 3) if ratios is None else np.asarray(ratios, dtype=np.float64)
    exposures = np.append(np.cumprod(R[::-1])[::-1], 1)
    E = 10 ** rng.uniform(-decades, 0, pixels)
    M = brightness(E[:, None] * exposures, c)
    M = M + sigma * rng.standard_normal(M.shape)
    return Trial(c, R, np.rint(255 * np.clip(M, 0, 1)).astype(np.intp))


def mean_error(c: ArrayLike, truth: ArrayLike) -> float:
    """Return the mean of |f - truth| over the pixel levels, in per cent of the range [Mitsunaga99 fig. 3].

    Examples
    --------
    >>> round(mean_error([0.4], []), 2)  # away from a straight line
    6.64
    """
    M = np.linspace(0, 1, 256)
    return float(100 * np.abs(value(M, c) - value(M, truth)).mean())


def literal_steps(M: Float, start: ArrayLike, *, order: int = 5) -> Iterator[tuple[Float, Float, float]]:
    """Yield c (order + 1,) of the powers of M, R (P - 1,) and the root mean square of eq. 7, for ever.

    As it stands in [Mitsunaga99 sec. 4], for samples M (N, P) that are all good; eq. 10 gets the 1 / N
    that it lacks in print.
    """
    R = np.asarray(start, dtype=np.float64)
    powers = M[..., None] ** np.arange(order + 1)
    while True:
        rows = np.concatenate([powers[:, q] - R[q] * powers[:, q + 1] for q in range(len(R))])
        A, last = rows[:, :-1] - rows[:, -1:], rows[:, -1]  # c_N = 1 - sum of the others [eq. 8]
        c = np.linalg.solve(A.T @ A, -A.T @ last)  # dE / dc_n = 0 [eq. 9]
        c = np.append(c, 1 - c.sum())
        f = powers @ c
        R = np.mean(f[:, :-1] / f[:, 1:], axis=0)  # [eq. 10]
        yield c, R, float(np.sqrt(np.mean((rows @ c) ** 2)))


def drift(one: Trial, start: ArrayLike, *, turns: int = 300) -> Drift:
    """Return what the literal scheme does in that many turns: the error falls or rests, and u wanders off.

    Each curve is compared with the truth, and with the truth to the power u = ln R / ln (true R): the second
    fits ever better, so what moves is u and nothing else.
    """
    M = average(one.Z)
    M = M[np.all((M > 0.05) & (M < 0.98), axis=1)]
    z = np.linspace(0, 1, 256)
    truth, rows = value(z, one.c), []
    for _, (c, R, error) in zip(range(turns), literal_steps(M, start, order=len(one.c) + 1), strict=False):
        f = np.polynomial.polynomial.polyval(z, c)
        u = np.mean(np.log(R)) / np.mean(np.log(one.R))
        rows.append((error, u, np.abs(f - truth).mean(), np.abs(f - truth**u).mean()))
    return Drift(*np.array(rows).T)


def normalised(M: Float, R: float, c: Float) -> float:
    """Return the error in brightness: the residual of eq. 5 over what a unit of noise in M does to it, rms.

    E itself cannot judge R: it is small wherever f is flat, and f^u is flat over most of its range.
    """
    return float(np.sqrt(np.mean(misfit(M, R, c) ** 2)))


def errors_along(M: Float, R: ArrayLike, order: int) -> Float:
    """Return the normalised error of the best c at each of the ratios R (K,), for two frames M (N, 2)."""
    samples, M = neighbours(M, order), M[in_range(M)[:, 0]]
    return np.array([normalised(M, r, coefficients(gram(*samples, np.array([r])))) for r in np.atleast_1d(R)])


def search(M: Float, start: float, order: int, *, reach: float = 1.25, steps: int = 81) -> float:
    """Return the ratio of two frames M (N, 2) with the lowest error in start / reach ... start * reach.

    The line search of [Mitsunaga99 sec. 4]. For clean samples, which leave no error at the truth: noise lifts
    that minimum and moves it far, and then taking turns is better.
    """
    R = start * reach ** np.linspace(-1, 1, steps)
    R = R[R < 1]
    k = int(np.argmin(errors_along(M, R, order)))
    fine = np.linspace(R[max(k - 1, 0)], R[min(k + 1, len(R) - 1)], steps)
    return float(fine[np.argmin(errors_along(M, fine, order))])


def valley(c: Float, *, ratio: float = 0.7, start: float = 0.625, sigma: float = 0.0, rng: int = 0) -> Valley:
    """Return figure 4 of the paper for a camera c: two frames, the truth at `ratio`, a guess at `start`.

    Samples are not quantised. With sigma = 0 the error touches 0 at the truth; with noise it does not.
    """
    draw = np.random.default_rng(rng)
    E = 10 ** draw.uniform(-2, 0, 1000)
    M = brightness(E[:, None] * [ratio, 1], c) + sigma * draw.standard_normal((1000, 2))
    order, R = len(c) + 1, np.linspace(0.3, 0.95, 261)
    error = errors_along(M, R, order)
    inner = (error[1:-1] < error[:-2]) & (error[1:-1] < error[2:])
    return Valley(R, error, R[1:-1][inner], search(M, start, order))
