"""Why self-calibration drifts: the u-ambiguity (Mitsunaga and Nayar, CVPR 1999, sec. 4 and 5).

M      brightness  (N, P) or, of two frames, (N, 2)
f_inv  f^-1        M -> exposure, f^-1(0) = 0, f^-1(1) = 1, a polynomial; c its coefficients: see `mitsunaga`
R      ratios      (P - 1,), exposure of a frame over that of the next longer one
u      exponent    (f^-u, R^u) solves f^-1(M_q) = R f^-1(M_q+1) whatever u is; u = 1 is the truth

The experiments of the paper: cameras and pictures drawn at random, its scheme as one writes it down
from the page, its drift when it is not stopped, and the error as a function of R.
"""

from collections.abc import Iterator
from itertools import islice
from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F64, ArrayLike, Indices
from hdrlab.response import polynomial, self_calibration
from hdrlab.response.mitsunaga import coefficients, gram, in_range, neighbours, terms, value


class Trial(NamedTuple):
    """A camera drawn at random and its photographs: c (order - 1,), R (P - 1,), pixel levels Z (N, P)."""

    c: F64
    R: F64
    Z: Indices


class Drift(NamedTuple):
    """Of each iteration (K,): rms of eq. 7, u, means of |f_inv - truth| and of |f_inv - truth^u|."""

    error: F64
    u: F64
    off: F64
    off_power: F64


def draw_curve(rng: np.random.Generator, *, order: int = 5, least: float = 0.02) -> F64:
    """Return c of a rising polynomial drawn at random.

    Powers M ... M^N get coefficients uniform in -1 ... 1, scaled to f^-1(1) = 1; drawn again until
    the slope is `least` or more.
    """
    n = np.arange(1, order + 1)
    while True:
        a = rng.uniform(-1, 1, order)
        if np.min(polynomial.GRID[:, None] ** (n - 1) @ (n * a / a.sum())) >= least:
            break
    M = (np.arange(order - 1) + 0.5) / (order - 1)  # N - 1 points fix the N - 1 numbers c
    return np.asarray(np.linalg.solve(terms(M, order)[:, 1:], M[:, None] ** n @ (a / a.sum()) - M))


def draw_trial(
    rng: np.random.Generator,
    *,
    ratios: ArrayLike | None = None,
    pixels: int = 10_000,
    sigma: float = 0.005,
) -> Trial:
    """Return a trial of [Mitsunaga99 sec. 5]: a random rising curve, four frames, noise, 256 levels.

    The paper leaves the distributions open. Here: ratios uniform in 0.45 ... 0.55; radiance uniform
    in its logarithm, two decades wide, the brightest just filling the longest exposure; the curve
    as `draw_curve` draws it.
    """
    c = draw_curve(rng)
    R = rng.uniform(0.45, 0.55, 3) if ratios is None else np.asarray(ratios, dtype=np.float64)
    exposures = np.append(np.cumprod(R[::-1])[::-1], 1)
    E = 10 ** rng.uniform(-2, 0, pixels)
    M = polynomial.brightness(E[:, None] * exposures, c)
    M = M + sigma * rng.standard_normal(M.shape)
    return Trial(c, R, np.rint(255 * np.clip(M, 0, 1)).astype(np.intp))


def mean_error(c: ArrayLike, truth: ArrayLike) -> float:
    """Return the mean of |f_inv - truth| over the pixel levels, percent of the range [Mitsunaga99 fig. 3].

    Examples
    --------
    >>> round(mean_error([0.4], []), 2)  # away from a straight line
    6.64
    """
    M = np.linspace(0, 1, 256)
    return float(100 * np.abs(value(M, c) - value(M, truth)).mean())


def literal_steps(M: F64, start: ArrayLike, *, order: int = 5) -> Iterator[tuple[F64, F64, float]]:
    """Yield c (order + 1,) of the powers of M, R (P - 1,) and the root mean square of eq. 7, for ever.

    As it stands in [Mitsunaga99 sec. 4], for samples M (N, P) that are all good; eq. 10 gets the 1
    / N that it lacks in print.
    """
    R = np.asarray(start, dtype=np.float64)
    powers = M[..., None] ** np.arange(order + 1)
    while True:
        rows = np.concatenate([powers[:, q] - R[q] * powers[:, q + 1] for q in range(len(R))])
        # c_N = 1 - sum of the others [eq. 8]
        A = rows[:, :-1] - rows[:, -1:]
        last = rows[:, -1]
        c = np.linalg.solve(A.T @ A, -A.T @ last)  # dE / dc_n = 0 [eq. 9]
        c = np.append(c, 1 - c.sum())
        f_inv = powers @ c
        R = np.mean(f_inv[:, :-1] / f_inv[:, 1:], axis=0)  # [eq. 10]
        yield c, R, float(np.sqrt(np.mean((rows @ c) ** 2)))


def measure_drift(one: Trial, start: ArrayLike, *, iterations: int = 300) -> Drift:
    """Return the Drift of the literal scheme in so many iterations: the error falls or rests, u drifts.

    Each curve is compared with the truth, and with the truth to the power u = ln R / ln (true R):
    the second fits ever better, so u alone drifts.
    """
    M = self_calibration.average(one.Z)
    M = M[np.all((M > 0.05) & (M < 0.98), axis=1)]
    z = np.linspace(0, 1, 256)
    truth = value(z, one.c)
    rows = []
    for c, R, error in islice(literal_steps(M, start, order=len(one.c) + 1), iterations):
        f_inv = np.polynomial.polynomial.polyval(z, c)
        u = np.mean(np.log(R)) / np.mean(np.log(one.R))
        rows.append((error, u, np.abs(f_inv - truth).mean(), np.abs(f_inv - truth**u).mean()))
    return Drift(*np.array(rows).T)


def brightness_error(M: F64, R: F64, c: F64) -> float:
    """Return the error in brightness: the residual of eq. 5 over what a unit of noise in M does to it, rms.

    Eq. 7 itself does not measure R: it is small wherever f^-1 is flat, as f^-u is over most of its
    range.
    """
    return float(np.sqrt(np.mean(polynomial.misfit(M, R, c) ** 2)))


def scan_ratios(M: F64, R: ArrayLike, order: int) -> F64:
    """Return the `brightness_error` of the best c at each of the ratios R (K,), for two frames M (N, 2)."""
    samples = neighbours(M, order)
    M = M[in_range(M)[:, 0]]
    errors = []
    for ratio in np.atleast_1d(R)[:, None]:
        c = coefficients(gram(*samples, ratio))
        errors.append(brightness_error(M, ratio, c))
    return np.array(errors)
