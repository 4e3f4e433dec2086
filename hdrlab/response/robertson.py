"""The response curve by alternation (Robertson, Borman and Stevenson, Journal of Electronic Imaging 2003).

Z       pixel levels       (N, P) integers 0 ... n - 1: sample i in frame j
t       exposure times     (P,); only their ratios matter
w       weights            (n,), 0 where a level is not to be trusted
f_inv   f^-1               (n,), the exposure of each level, 1 at level n // 2; the verb returns g = ln f^-1
E       irradiance         (N,), exposure per unit of t; NaN for a sample without weight
E_m                        all (i, j) with Z_ij = m
lambda                     `smoothness`, which the paper does not have

If f^-1 were known, the most likely E would be a mean; if E were known, f^-1 would be one. So each is
computed from the other in turn, starting from the f^-1 of a linear camera.

The photographs do not determine f^-1 completely. If all times are powers of one ratio r, then f^-1
times any function of ln E with the period ln r explains them as well, and the initial guess decides.
So the paper's scheme stays up to 4 % off where frames are 2 stops apart, and 0.5 % at 1 stop. And
noise makes it drift, slowly, long after it has settled.
"""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from hdrlab.core import sampling, weights
from hdrlab.core.arrays import F64, ArrayLike, Indices, as_stack
from hdrlab.core.steps import last
from hdrlab.errors import InputError


class State(NamedTuple):
    """f^-1 after an iteration, and its largest change."""

    f_inv: F64
    change: float


def irradiance(Z: Indices, t: F64, f_inv: F64, w: F64) -> F64:
    """Return E_i = sum_j w f^-1(Z_ij) t_j / sum_j w t_j^2 [Robertson03 eq. 8]; NaN for 0 / 0."""
    with np.errstate(invalid="ignore"):
        return (w[Z] * f_inv[Z]) @ t / (w[Z] @ t**2)


def update(Z: Indices, t: F64, E: F64, n: int = 256) -> F64:
    """Return f^-1(m), the mean of E_i t_j over E_m; NaN where E_m is empty.

    It is a plain mean, because weights would bias it.
    """
    known = ~np.isnan(E)
    levels = Z[known].ravel().astype(np.intp)
    X = E[known, None] * t
    total = np.bincount(levels, X.ravel(), n)
    count = np.bincount(levels, minlength=n)
    with np.errstate(invalid="ignore"):
        return total / count


def linear(n: int = 256) -> F64:
    """Return f^-1 of the linear camera, the initial guess.

    Level 0 holds all light below half a level; its f^-1 is the middle of that.
    """
    return np.maximum(np.arange(n), 0.25) / (n // 2)


def fill(means: F64, w: F64) -> F64:
    """Return the means, with the levels that no sample constrains interpolated linearly.

    These are the levels without a mean; level 0, which holds all that is dark; and the levels
    beyond the cut, where noise mixes in clipped pixels. Levels at the end take the last mean.
    """
    level = np.arange(len(w))
    known = ~np.isnan(means) & (level > 0) & (level <= np.max(level[w > 0]))
    filled = np.interp(level, level[known], means[known])
    filled[0] = filled[1] / 4
    return filled


def alternate(Z: Indices, t: F64, w: F64) -> Callable[[F64], F64]:
    """Return the function of one iteration: f^-1 -> E -> the means that become the next f^-1."""

    def means(f_inv: F64) -> F64:
        E = irradiance(Z, t, f_inv, w)
        return update(Z, t, E, len(w))

    return means


def recover_steps(
    Z: Indices, times: ArrayLike, w: F64, *, tolerance: float = 1e-4, max_iterations: int = 200
) -> Iterator[State]:
    """Yield the State of one channel, before the first iteration and after each.

    Parameters
    ----------
    Z : (N, P) integers
        Pixel levels, 0 to 255.
    times : (P,) float
        Exposure times, in any unit.
    w : (256,) float
        Weights.
    tolerance : float
        The iteration ends when f^-1, 1 at level 128, changes by less than this at every level.
    max_iterations : int
        It ends after this number of iterations in any case.

    Raises
    ------
    ValueError
        If no sample is well exposed in two photos.

    Examples
    --------
    >>> Z = np.array([[16, 32, 64], [32, 64, 128]])  # a linear camera
    >>> [round(state.change, 3) for state in recover_steps(Z, [1, 2, 4], np.ones(256))]
    [inf, 0.992, 0.0]
    """
    t = np.asarray(times, np.float64) / np.max(times)
    sampling.require_two_exposures(Z, t, w)
    means = alternate(Z, t, w)
    f_inv = linear(len(w))
    yield State(f_inv, np.inf)
    for _ in range(max_iterations):
        new = fill(means(f_inv), w)
        new = new / new[len(w) // 2]
        change = float(np.max(np.abs(new - f_inv)))
        f_inv = new
        yield State(f_inv, change)
        if change < tolerance:
            return


def recover(
    images: ArrayLike,
    times: ArrayLike,
    *,
    samples: int = 4_000,
    w: ArrayLike | None = None,
    choose: Callable[..., Indices] = sampling.by_rank,
    valid: ArrayLike | None = None,
    steps: Callable[..., Iterator[State]] = recover_steps,
) -> F64:
    """Return the response g recovered from a bracket, each channel by itself.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Photographs; 16 bits are read at 256 levels.
    times : (P,) float
        Exposure times in seconds, at least two different ones.
    samples : int
        How many pixels to choose.
    w : (256,) float, optional
        Weights. The default is the Gaussian, cut below 0.02 and above 0.98 of the top level. Noise
        makes some clipped pixels look unclipped. Their weight is small, but it is multiplied by the
        square of the time, and without the cut they bend the curve.
    choose : function
        `sampling.by_rank` (default), `by_grid`, `every_pixel`, or your own with the same signature.
    valid : (P, H, W) bool, optional
        False where a photograph holds no picture.
    steps : function
        The iteration, with the signature of `recover_steps`; `fast.robertson` has a faster one.

    Returns
    -------
    (256,) or (256, 3) float64
        g, the ln exposure of each level, never falling; g[128] = 0. Levels above the cut have the
        value at the cut.

    Raises
    ------
    ValueError
        For photographs in which no pixel is well exposed twice, and for arrays that are no bracket.

    References
    ----------
    Robertson, Borman and Stevenson, Estimation-theoretic approach to dynamic range enhancement
    using multiple exposures, Journal of Electronic Imaging 12(2), 2003.

    Examples
    --------
    >>> ramp = np.linspace(1, 100, 10_000).reshape(100, 100)  # a linear camera
    >>> images = np.clip(np.round(ramp * np.array([1, 2, 4])[:, None, None]), 0, 255).astype(np.uint8)
    >>> g = recover(images, [0.01, 0.02, 0.04])
    >>> bool(abs(g[200] - np.log(200 / 128)) < 0.01)
    True
    """
    stack = as_stack(images)
    times = np.asarray(times, np.float64)
    if times.shape != (len(stack),) or not np.all((times > 0) & (times < np.inf)):
        raise InputError(f"expected {len(stack)} positive times in seconds, got {times}")
    if w is None:
        w = weights.cut(weights.gaussian(), below=0.02)
    w = np.asarray(w, np.float64)
    Z = choose(stack, samples, valid=valid)
    channels = sampling.split_channels(Z)
    curves = [last(steps(Z_channel, times, w)).f_inv for Z_channel in channels]
    g = np.log(np.stack(curves, axis=-1))
    return weights.make_monotone(g).reshape(256, *stack.shape[3:])
