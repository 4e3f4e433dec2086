"""Self-calibration of photographs: samples are averaged, and held-out parts choose the order.

The scheme is that of `mitsunaga`, with two departures. Samples are means of many pixels that are
alike. And the order of the polynomial is the least that other parts of the picture ask for; that of
least error, which the paper takes [Mitsunaga99 sec. 4], is the highest.

Z    pixel levels   (N, P) integers, 0 ... 255
M    brightness     (C, N, P), and R, c, H as in `mitsunaga`
"""

import math
from collections.abc import Sequence

import numpy as np

from hdrlab.core import bracket, sampling, steps
from hdrlab.core.arrays import F64, ArrayLike, Indices, as_mask, as_stack, as_times, describe
from hdrlab.errors import InputError
from hdrlab.response.mitsunaga import (
    Fit,
    coefficients,
    curve,
    fit_steps,
    gram,
    in_range,
    neighbours,
)
from hdrlab.response.polynomial import misfit

# the highest order that is tried
MAX_ORDER = 10
# A group with more clipped pixels than this fraction is left out. Fewer of them hardly change its
# mean, and near the top level there are always some.
MAX_CLIPPED_FRACTION = 0.1
# The order is chosen by cross-validation over this many parts of the picture. Each part is made of
# stripes: it takes every _PART_COUNT-th of them.
_PART_COUNT = 5
_STRIPE_COUNT = 20
# Errors in brightness that differ by less than a hundredth of a level count as equal.
_MIN_ERROR_DIFFERENCE = 0.01 / 255


def average(Z: ArrayLike, count: int = 80) -> F64:
    """Return M (count, P), the means of groups of similar pixels of Z (N, P); NaN where clipped.

    Pixels are similar if their means over the frames are. Sorted by the values of one frame, they
    would be sorted by its noise.
    """
    Z = np.asarray(Z)
    if Z.ndim != 2 or Z.dtype.kind not in "iu" or not Z.size or Z.min() < 0 or Z.max() > 255:
        raise InputError(f"expected levels 0 to 255, Z (N, P), got {describe(Z)}")
    frames = np.ascontiguousarray(Z.T, dtype=np.uint8)
    key = 256 * frames.sum(axis=0, dtype=np.uint32) // len(frames)
    order = np.argsort(key.astype(np.uint16), kind="stable")  # 16 bits are sorted by counting
    frames = frames[:, order]
    starts = np.linspace(0, len(Z), min(count, len(Z)), endpoint=False).astype(int)
    members = np.diff(np.append(starts, len(Z)))
    clipped = np.add.reduceat((frames == 0) | (frames == 255), starts, axis=1, dtype=int)
    M = np.add.reduceat(frames, starts, axis=1, dtype=float) / (255 * members)
    return np.where(clipped > MAX_CLIPPED_FRACTION * members, np.nan, M).T


def held_out(parts: Sequence[F64], R: F64) -> F64:
    """Return the error (MAX_ORDER, K) of each order in each of K parts, with c from all other parts.

    It is the RMS error in brightness. The error of eq. 7 would be small wherever f^-1 is flat, and
    high orders make it flat. And R stays as stated: with other ratios a straight line explains a
    power law as well as the power law does.
    """
    H = np.array([[_gram_of_channel(M_channel, R) for M_channel in M] for M in parts])
    errors = np.zeros((MAX_ORDER, len(parts)))
    for k, M in enumerate(parts):
        if not in_range(M).any():
            continue
        H_others = np.delete(H, k, axis=0).sum(axis=0)
        for order in range(1, MAX_ORDER + 1):
            residuals = []
            for M_channel, H_channel in zip(M, H_others, strict=True):
                c = coefficients(H_channel[:order, :order])
                residuals.append(misfit(M_channel, R, c)[in_range(M_channel)])
            errors[order - 1, k] = np.sqrt(np.mean(np.concatenate(residuals) ** 2))
    return errors


def _gram_of_channel(M: F64, R: F64) -> F64:
    """Return H of eq. 7 for samples M (N, P) of one channel; its leading blocks are of lower orders."""
    a, b, q = neighbours(M, MAX_ORDER)
    return gram(a, b, q, R)


def choose_order(parts: Sequence[F64], R: ArrayLike) -> int:
    """Return the lowest order whose held-out error is within a standard error of the best [Breiman84 3.4.3].

    It is one order for all channels, from samples M (C, N, P) of each part of a picture. The parts
    must be separate regions. If each held pixels from all over the picture, then motion and flare
    would be in all of them, and one part would confirm another's error.
    """
    if len(parts) < 2:
        return 1
    errors = held_out(parts, np.asarray(R, np.float64))
    mean = errors.mean(axis=1)
    best = int(np.argmin(mean))
    doubt = np.std(errors[best], ddof=1) / np.sqrt(len(parts))
    return 1 + int(np.argmax(mean <= mean[best] + max(doubt, _MIN_ERROR_DIFFERENCE)))


def levels_by_time(
    images: ArrayLike, times: ArrayLike, pixels: int, *, valid: ArrayLike | None
) -> tuple[Indices, F64]:
    """Return levels Z (C, N, P) of a grid of pixels, from short to long, and the ratios R of the times."""
    stack = as_stack(images)
    times = as_times(times, len(stack), distinct=2)
    by_time = bracket.short_to_long(stack, times)
    Z = sampling.by_grid(stack, pixels, valid=as_mask(valid, stack))[:, by_time]
    times = times[by_time]
    return sampling.split_channels(Z), times[:-1] / times[1:]


def samples(
    images: ArrayLike,
    times: ArrayLike,
    *,
    pixels: int = 12_000,
    count: int = 400,
    valid: ArrayLike | None,
) -> tuple[list[F64], F64]:
    """Return samples of a bracket, from short to long, and the ratios R (P - 1,) of its times.

    The samples are grouped by parts of the picture, M (C, N, P) each.
    """
    Z, R = levels_by_time(images, times, pixels, valid=valid)
    # the pixels of the grid are in order of their rows
    stripes = np.array_split(np.arange(Z.shape[1]), _STRIPE_COUNT)
    count_per_part = math.ceil(count / _PART_COUNT)
    parts = []
    for k in range(min(_PART_COUNT, Z.shape[1])):
        Z_part = Z[:, np.concatenate(stripes[k::_PART_COUNT])]
        parts.append(np.stack([average(Z_channel, count_per_part) for Z_channel in Z_part]))
    return parts, R


def calibrate(
    images: ArrayLike,
    times: ArrayLike,
    *,
    order: int | None = None,
    eps: float = 1e-3,
    valid: ArrayLike | None = None,
) -> Fit:
    """Return the coefficients, and the ratios of each exposure to the next, of a bracket.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Photographs, aligned; 16 bits are read at 256 levels.
    times : (P,) float
        Exposure times in seconds, at least two different ones. Errors of 10 % are partly corrected.
    order : int, optional
        Order of the polynomial; by default the lowest of 1 to 10 whose held-out error is within a
        standard error of the best.
    eps : float
        Stop when f^-1, 0 to 1, changes by less than this. With a smaller eps the ratios drift
        further from the times.
    valid : (P, H, W) bool, optional
        False where a photograph holds no picture.

    Raises
    ------
    ValueError
        For fewer than two photographs or two times, and photographs that share no levels worth
        using.

    References
    ----------
    Mitsunaga and Nayar, Radiometric self calibration, CVPR 1999. For the standard error, Breiman,
    Friedman, Olshen and Stone, Classification and regression trees, 1984, sec. 3.4.3.

    Examples
    --------
    >>> ramp = np.linspace(1, 100, 10_000).reshape(100, 100)  # a linear camera
    >>> images = np.clip(np.round(ramp * np.array([1, 2, 4])[:, None, None]), 0, 255).astype(np.uint8)
    >>> calibrate(images, [0.01, 0.02, 0.04]).R.round(2).tolist()
    [0.5, 0.5]
    """
    parts, R = samples(images, times, valid=valid)
    M = np.concatenate(parts, axis=1)
    if not np.all(in_range(M).any(axis=(1, 2))):
        raise InputError(
            "expected pixels from 0.05 to 0.98 of the largest value in two neighboring photos"
        )
    if order is None:
        order = choose_order(parts, R)
    return steps.last(fit_steps(M, R, order, eps=eps))


def find_response(
    images: ArrayLike,
    times: ArrayLike,
    *,
    order: int | None = None,
    eps: float = 1e-3,
    valid: ArrayLike | None = None,
) -> F64:
    """Return the response g (256,) or (256, 3), which rises, with g[128] = 0.

    The parameters are those of `calibrate`.
    """
    fit = calibrate(images, times, order=order, eps=eps, valid=valid)
    g = np.stack([curve(c) for c in fit.c], axis=-1)
    return g.reshape(256, *np.shape(images)[3:])
