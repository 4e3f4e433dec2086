"""The response curve by alternation (Robertson, Borman and Stevenson, Journal of Electronic Imaging 2003).

Z   pixel levels       (N, P) integers 0 ... n - 1: sample i in frame j
t   exposure times     (P,); only their ratios matter
w   weights            (n,), 0 where a level is not to be trusted
f   f^-1               (n,), the exposure of each level, 1 at level n // 2; the verb returns g = ln f
E   irradiance         (N,), exposure per unit of t; NaN for a sample that no frame saw well
E_m                    all (i, j) with Z_ij = m

Were f known, the most likely E would be a mean; were E known, f would be one. So each is made from the other,
turn by turn, from the line of a linear camera on. A turn is linear in f (see `joint`), a power iteration.

What the photographs leave open, the start decides: where all times are powers of one ratio r, f times any
function of ln E with the period ln r explains them as well as f. So the paper's scheme stays up to 4 % off
where frames are 2 stops apart, 0.5 % at 1 stop; and noise makes it drift, slowly, long after it has settled.
`smoothness` ties the parts of a period together with Debevec and Malik's penalty on bends; 0 is the paper's.
"""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import solveh_banded

from hdrlab.core import weights
from hdrlab.core.arrays import Array, as_mask, as_stack, as_table, as_times, describe, to_256
from hdrlab.core.sampling import by_rank
from hdrlab.core.steps import last
from hdrlab.core.weights import make_monotone, second_differences
from hdrlab.response.joint import Table, table, turned

Float = NDArray[np.float64]
ENOUGH = 2**16  # pixels of a frame: an even choice of about so many has the ranks of all


class State(NamedTuple):
    """The curve f after a turn, by how much it changed at most, and which levels (n,) no sample told of."""

    f: Float
    change: float
    empty: NDArray[np.bool_]


def irradiance(Z: Array, t: Float, f: Float, w: Float) -> Float:
    """Return E_i = sum_j w f(Z_ij) t_j / sum_j w t_j^2 [Robertson03 eq. 8]; NaN for 0 / 0."""
    with np.errstate(invalid="ignore"):
        return (w[Z] * f[Z]) @ t / (w[Z] @ t**2)


def update(Z: Array, t: Float, E: Float, n: int = 256) -> Float:
    """Return f(m), the plain mean of E_i t_j over E_m: weights would bias it; NaN where E_m is empty."""
    known = ~np.isnan(E)
    X = E[known, None] * t
    with np.errstate(invalid="ignore"):
        return np.bincount(Z[known].ravel(), X.ravel(), n) / np.bincount(Z[known].ravel(), minlength=n)


def line(n: int = 256) -> Float:
    """Return f of the linear camera, where the turns begin; level 0 is all below half a level."""
    return np.maximum(np.arange(n), 0.25) / (n // 2)


def empty_levels(pixels: ArrayLike, w: ArrayLike) -> NDArray[np.bool_]:
    """Return (n,), the levels of which the samples tell nothing: without pixels, 0, and those beyond the cut.

    Level 0 is all that is dark, the top one all that is bright, and noise carries that to the levels beside
    it.
    """
    w, level = np.asarray(w), np.arange(len(np.asarray(w)))
    return (np.asarray(pixels) == 0) | (level == 0) | (level > np.max(level[w > 0], initial=0))


def fill(f: Float, empty: NDArray[np.bool_]) -> Float:
    """Return f with its empty levels on lines between their neighbours, those at the end like the last."""
    filled = np.interp(np.arange(len(f)), np.flatnonzero(~empty), f[~empty])
    return np.concatenate([[filled[1] / 4], filled[1:]])


def smoother(empty: NDArray[np.bool_], w: Float, smoothness: float) -> Float:
    """Return the matrix that takes r (n,) to the s of least sum (s - r)^2 + sum (lambda w s'')^2.

    Empty levels are left out of the first sum.
    """
    bends = second_differences(w, smoothness)
    data = np.diag(np.where(empty, 1e-6, 1.0))
    A = data + bends.T @ bends  # five diagonals, of which the lower three tell all
    bands = [np.pad(np.diagonal(A, -k), (0, k)) for k in range(3)]
    return np.asarray(solveh_banded(bands, data, lower=True))


def step(f: Float, samples: Table, w: Float, empty: NDArray[np.bool_], smooth: Float | None = None) -> Float:
    """Return f after a turn: new means, empty levels filled, smoothed if asked, f(n // 2) = 1.

    What is smoothed is ln f less that of the line, so that the line stays a line.
    """
    new = fill(turned(f, samples, w), empty)
    if smooth is not None:
        new = line(len(f)) * np.exp(smooth @ np.log(new / line(len(f))))
    return new / new[len(f) // 2]


def recover_steps(
    Z: ArrayLike,
    times: ArrayLike,
    w: ArrayLike,
    *,
    smoothness: float = 100.0,
    tolerance: float = 1e-4,
    turns: int = 200,
) -> Iterator[State]:
    """Yield the State of one channel, before the first turn and after each; knobs as in `recover`."""
    Z, w = np.asarray(Z), as_table(w, 256)
    if Z.ndim != 2 or Z.dtype.kind not in "iu" or not 0 <= smoothness < np.inf:
        got = f"{describe(Z)} and smoothness {smoothness}"
        raise ValueError(
            f"expected levels Z (N, P) and a smoothness that is finite and not negative, got {got}"
        )
    t = as_times(times, Z.shape[1])
    samples = table(Z, t / t.max(), w)
    if not samples.tied:
        raise ValueError("expected samples seen well in two exposures, which tie levels together; got none")
    empty = empty_levels(samples.pixels, w)
    smooth = smoother(empty, w, smoothness) if smoothness > 0 else None
    f, change = line(len(w)), np.inf
    yield State(f, change, empty)
    while turns > 0 and change >= tolerance:
        f, before, turns = step(f, samples, w, empty, smooth), f, turns - 1
        change = float(np.max(np.abs(f - before)))
        yield State(f, change, empty)


def recover(
    images: ArrayLike,
    times: ArrayLike,
    *,
    smoothness: float = 100.0,
    tolerance: float = 1e-4,
    turns: int = 200,
    samples: int | None = 4_000,
    w: ArrayLike | None = None,
    choose: Callable[..., NDArray[np.intp]] = by_rank,
    valid: ArrayLike | None = None,
) -> Float:
    """Return the response g recovered from a bracket, each channel by itself.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Photographs; 16 bits are read at 256 levels.
    times : (P,) float
        Exposure times in seconds, at least two different ones.
    smoothness : float
        lambda of a penalty on bends after each turn; 0 for the paper's scheme, with some 30 turns.
    tolerance : float
        The turns end when f, 1 at the middle level, changes by less than this at every level ...
    turns : int
        ... or after so many.
    samples : int or None
        How many pixels to choose; None for all of them, which must then be aligned.
    w : (256,) float, optional
        Weights; the Gaussian, cut below 0.02 and above 0.98 of the top level: a clipped pixel that noise
        brought back among the others weighs little, but times the square of its time, and bends the curve.
    choose : function
        `sampling.by_rank` (default), `sampling.by_grid`, or your own with the same signature.
    valid : (P, H, W) bool, optional
        False where a photograph holds no picture.

    Returns
    -------
    (256,) or (256, 3) float64
        g, the ln exposure of each level, never falling; g[128] = 0. Levels above the cut take its value.

    Raises
    ------
    ValueError
        For photographs that hold no level seen in two exposures, and for arrays that are no bracket.

    References
    ----------
    Robertson, Borman and Stevenson, Estimation-theoretic approach to dynamic range enhancement using multiple
    exposures, Journal of Electronic Imaging 12(2), 2003.

    Examples
    --------
    >>> ramp = np.linspace(1, 100, 10_000).reshape(100, 100)  # a linear camera
    >>> images = np.clip(np.round(ramp * np.array([1, 2, 4])[:, None, None]), 0, 255).astype(np.uint8)
    >>> g = recover(images, [0.01, 0.02, 0.04])
    >>> bool(abs(g[200] - np.log(200 / 128)) < 0.01)
    True
    """
    stack = as_stack(images)
    times = as_times(times, len(stack))
    w = weights.cut(weights.gaussian(), below=0.02) if w is None else as_table(w, 256)

    def found(Z: Array) -> Float:
        return last(recover_steps(Z, times, w, smoothness=smoothness, tolerance=tolerance, turns=turns)).f

    channels = chosen(stack, samples, choose, as_mask(valid, stack))
    f = np.stack([found(Z) for Z in channels], axis=-1)
    return make_monotone(np.log(f)).reshape(256, *stack.shape[3:])


def chosen(
    stack: Array, samples: int | None, choose: Callable[..., Array], valid: NDArray[np.bool_] | None
) -> list[Array]:
    """Return the samples Z (N, P) of each channel: all pixels that every frame shows, or so many of them."""
    if samples is None:
        shown = slice(None) if valid is None else valid.all(axis=0).ravel()
        pixels = to_256(stack).reshape(len(stack), stack.shape[1] * stack.shape[2], -1)
        return [pixels[:, shown, c].T for c in range(pixels.shape[-1])]
    every = max(1, int(np.sqrt(stack.shape[1] * stack.shape[2] / max(ENOUGH, 4 * samples))))
    few = (slice(None), slice(every // 2, None, every), slice(every // 2, None, every))
    Z = choose(stack[few], samples, valid=None if valid is None else valid[few])
    return list(np.moveaxis(Z.reshape(*Z.shape[:2], -1), -1, 0))
