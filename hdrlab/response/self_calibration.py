"""Self-calibration of photographs: samples are averaged, and held-out parts choose the order.

The scheme is that of `mitsunaga`, with two departures. Samples are means of many pixels that are
alike. And the order of the polynomial is the least that other parts of the picture ask for; that of
least error, which the paper takes [Mitsunaga99 sec. 4], is the highest.

Z    pixel levels   (N, P) integers, 0 ... 255
M    brightness     (C, N, P), and R, c, H as in `mitsunaga`
"""

from collections.abc import Sequence
from typing import Any

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

# order that is tried
HIGHEST = 10
# share of a group; fewer clipped members hardly move its mean, and near the top there are always a
# few
CLIPPED = 0.1
# of the picture, for the choice of the order: a part is every fifth stripe
PARTS = 5
STRIPES = 20
# in brightness, a hundredth of a level: what is less is no difference
FINEST = 0.01 / 255


def average(Z: ArrayLike, count: int = 80) -> F64:
    """Return M (count, P), means of groups of pixels Z (N, P) that are alike; NaN where some are clipped.

    Alike: near in the mean over the frames. Sorted by one frame's values, they would be sorted by
    its noise.
    """
    Z = np.asarray(Z)
    if Z.ndim != 2 or Z.dtype.kind not in "iu" or not Z.size or Z.min() < 0 or Z.max() > 255:
        raise InputError(f"expected levels 0 to 255, Z (N, P), got {describe(Z)}")
    frames = np.ascontiguousarray(Z.T, dtype=np.uint8)
    key = 256 * frames.sum(axis=0, dtype=np.uint32) // len(frames)
    frames = frames[
        :, np.argsort(key.astype(np.uint16), kind="stable")
    ]  # 16 bits are sorted by counting
    starts = np.linspace(0, len(Z), min(count, len(Z)), endpoint=False).astype(int)
    members = np.diff(np.append(starts, len(Z)))
    clipped = np.add.reduceat((frames == 0) | (frames == 255), starts, axis=1, dtype=int)
    M = np.add.reduceat(frames, starts, axis=1, dtype=float) / (255 * members)
    return np.where(clipped > CLIPPED * members, np.nan, M).T


def held_out(parts: Sequence[F64], R: F64) -> F64:
    """Return the error (HIGHEST, K) of each order in each part of the picture, under the c of all others.

    Rms in brightness, not that of eq. 7, which is small wherever f^-1 is flat, and high orders make
    it so. And R stays as stated: a straight line explains a power law as well as the power does,
    with ratios of its own.
    """
    H = np.array([[gram(*neighbours(own, HIGHEST), R) for own in M] for M in parts])
    errors = np.zeros((HIGHEST, len(parts)))
    for k, M in enumerate(parts):
        others = np.delete(H, k, axis=0).sum(axis=0)
        for n in range(1, HIGHEST + 1):
            left = [
                misfit(own, R, coefficients(h[:n, :n]))[in_range(own)]
                for own, h in zip(M, others, strict=True)
            ]
            errors[n - 1, k] = (
                np.sqrt(np.mean(np.concatenate(left) ** 2)) if in_range(M).any() else 0
            )
    return errors


def choose_order(parts: Sequence[F64], R: ArrayLike) -> int:
    """Return the least order whose held-out error is within a standard error of the best [Breiman84 3.4.3].

    One for all channels, from samples M (C, N, P) of each part of a picture. Halves of samples that
    each hold pixels from all over it would not do: what motion and flare add stands in both, and
    they confirm it.
    """
    if len(parts) < 2:
        return 1
    errors = held_out(parts, np.asarray(R, np.float64))
    mean = errors.mean(axis=1)
    best = int(np.argmin(mean))
    doubt = np.std(errors[best], ddof=1) / np.sqrt(len(parts))
    return 1 + int(np.argmax(mean <= mean[best] + max(doubt, FINEST)))


def levels_by_time(
    images: ArrayLike, times: ArrayLike, pixels: int, *, valid: ArrayLike | None
) -> tuple[Indices, F64]:
    """Return levels Z (C, N, P) of a grid of pixels, from short to long, and the ratios R of the times."""
    stack = as_stack(images)
    times = as_times(times, len(stack), distinct=2)
    by_time = bracket.short_to_long(stack, times)
    Z = sampling.by_grid(stack, pixels, valid=as_mask(valid, stack))[:, by_time]
    return np.moveaxis(Z.reshape(*Z.shape[:2], -1), -1, 0), times[by_time][:-1] / times[by_time][1:]


def samples(
    images: ArrayLike,
    times: ArrayLike,
    *,
    pixels: int = 12_000,
    count: int = 400,
    valid: ArrayLike | None,
) -> tuple[list[F64], F64]:
    """Return samples of a bracket, from short to long, and the ratios R (P - 1,) of its times.

    The samples come in PARTS of the picture, M (C, N, P) each: every PARTS-th of its STRIPES.
    """
    Z, R = levels_by_time(images, times, pixels, valid=valid)
    stripes = np.array_split(np.arange(Z.shape[1]), STRIPES)  # the grid's pixels come row by row
    parts = [Z[:, np.concatenate(stripes[k::PARTS])] for k in range(min(PARTS, Z.shape[1]))]
    M = [np.stack([average(one, -(-count // PARTS)) for one in part]) for part in parts]
    return M, R


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
        Exposure times in seconds, at least two different ones. Errors of a tenth are corrected in
        part.
    order : int, optional
        Of the polynomial; by default the least of 1 to 10 whose held-out error is within a standard
        error of the best.
    eps : float
        Stop when f^-1, 0 to 1, changes by less. A smaller one lets the ratios drift further from
        the times.
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
            "expected pixels from 0.05 to 0.98 of the top level in two neighbours; got none"
        )
    return steps.last(fit_steps(M, R, choose_order(parts, R) if order is None else order, eps=eps))


def find_response(
    images: ArrayLike, times: ArrayLike, *, valid: ArrayLike | None = None, **knobs: Any
) -> F64:
    """Return the response g (256,) or (256, 3), rising, g[128] = 0. Parameters as of `calibrate`."""
    g = np.stack([curve(c) for c in calibrate(images, times, valid=valid, **knobs).c], axis=-1)
    return g.reshape(256, *np.shape(images)[3:])
