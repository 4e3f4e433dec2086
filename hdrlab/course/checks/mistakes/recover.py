"""Known mistakes in `recover`, the task of hdrlab.response.mitsunaga.recover."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.response.mitsunaga import (
    Fit,
    coefficients,
    curve,
    fit_steps,
    gram,
    neighbours,
    terms,
    value,
)


@mistake(
    "recover_one_curve_for_all",
    says="Each channel has its own curve: for color photos, g is (256, 3). You return the green "
    "curve for all channels.",
)
def one_curve_for_all(images, times, *, order=5, eps=0.001):
    images = np.asarray(images if np.ndim(images) == 3 else images[..., 1])
    t = np.asarray(times, np.float64)
    images = images[np.argsort(t)]
    t = np.sort(t)
    # an even grid of some thousand pixels
    every = max(1, int(np.sqrt(images.size / len(t) / 12_000)))
    M = (
        images[:, ::every, ::every].reshape(len(t), -1, images[0, 0, 0].size).T
        / np.iinfo(images.dtype).max
    )
    *_, state = fit_steps(M, t[:-1] / t[1:], order, eps=eps)
    return np.stack([curve(c) for c in state.c], axis=-1).reshape(256, *images.shape[3:])


@mistake(
    "recover_times_believed",
    says="You trust the given times. After each fit, compute the ratios from the new curve: R "
    "= sum f^-1(M_q) / sum f^-1(M_q+1).",
)
def times_believed(images, times, *, order=5, eps=0.001):
    def fit_steps(M, R, order, *, eps=0.001, max_iterations=30):
        channels = [neighbours(own, order) for own in M]
        levels = terms(np.linspace(0, 1, 256), order)[:, 1:]
        R = np.asarray(R)
        before = np.full(256, np.inf)
        for _ in range(max_iterations):
            c = np.stack([coefficients(gram(*channel, R)) for channel in channels])
            curves = c @ levels.T
            change = float(np.max(np.abs(curves - before)))
            before = curves
            yield Fit(c, R, change)
            if change < eps:
                return

    images = np.asarray(images)
    t = np.asarray(times, np.float64)
    images = images[np.argsort(t)]
    t = np.sort(t)
    # an even grid of some thousand pixels
    every = max(1, int(np.sqrt(images.size / len(t) / 12_000)))
    M = (
        images[:, ::every, ::every].reshape(len(t), -1, images[0, 0, 0].size).T
        / np.iinfo(images.dtype).max
    )
    *_, state = fit_steps(M, t[:-1] / t[1:], order, eps=eps)
    return np.stack([curve(c) for c in state.c], axis=-1).reshape(256, *images.shape[3:])


@mistake(
    "recover_response_not_inverse",
    says="You return f^-1, the exposure of each pixel value. Return its logarithm, g = ln f^-1.",
)
def response_not_inverse(images, times, *, order=5, eps=0.001):
    def curve(c, n=256, *, least=0.0001):
        increments = np.maximum(np.diff(value(np.linspace(0, 1, n), c)), least / (n - 1))
        f_inv = np.cumsum(np.append(increments[0] / 4, [0.75 * increments[0], *increments[1:]]))
        return f_inv / f_inv[n // 2]

    images = np.asarray(images)
    t = np.asarray(times, np.float64)
    images = images[np.argsort(t)]
    t = np.sort(t)
    # an even grid of some thousand pixels
    every = max(1, int(np.sqrt(images.size / len(t) / 12_000)))
    M = (
        images[:, ::every, ::every].reshape(len(t), -1, images[0, 0, 0].size).T
        / np.iinfo(images.dtype).max
    )
    *_, state = fit_steps(M, t[:-1] / t[1:], order, eps=eps)
    return np.stack([curve(c) for c in state.c], axis=-1).reshape(256, *images.shape[3:])
