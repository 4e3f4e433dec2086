"""Robertson's iterations as products with one matrix, from joint histograms of the frames.

Z       pixel levels       (N, P) integers 0 ... n - 1: sample i in frame j
t       exposure times     (P,)
w       weights            (n,), 0 where a level is not to be trusted
f_inv   f^-1               (n,), the exposure of each level
d       each sample's sum of w(Z_ij) t_j^2 over its frames, (N,)

An iteration goes over all pixels twice, from f^-1 to irradiances and back. But it is linear in
f^-1, and its sum over the pixels with level m in one frame and level z in another has the same
weight in every iteration. These weights are summed once, in the joint histograms of the frames.
Then an iteration is a product with an (n, n) matrix, whatever the number of samples.
"""

from collections.abc import Callable, Iterator

import numpy as np
import scipy

from hdrlab.core import sampling, weights
from hdrlab.core.arrays import F64, ArrayLike, Indices, as_mask, as_stack, as_times
from hdrlab.errors import InputError
from hdrlab.fast import with_parts
from hdrlab.response import robertson

# as many samples as have indices that stay in the processor's cache
SAMPLES_PER_BLOCK = 2**15
# ranks are computed from a regular grid of about this many pixels
RANKED_PIXELS = 2**16


class Joint:
    """The matrix S (n, n): sums of t_j t_k / d_i over the samples with Z_ij = m and Z_ik = z.

    S is symmetric, so a pair of frames is counted once. Called with f^-1 it returns the means of
    the next.
    """

    def __init__(self, Z: Indices, t: F64, w: F64) -> None:
        n = len(w)
        P = Z.shape[1]
        pairs = np.zeros(n * n)
        own = np.zeros(n)
        self.pixels = np.zeros(n, np.int64)
        self.w = w
        for start in range(0, len(Z), SAMPLES_PER_BLOCK):
            z = Z[start : start + SAMPLES_PER_BLOCK].T.astype(np.intp)
            d = t**2 @ w[z]
            if not d.all():
                z = z[:, d > 0]
                d = d[d > 0]
            self.pixels += np.bincount(z.ravel(), minlength=n)
            for j in range(P):
                own += np.bincount(z[j], t[j] ** 2 / d, n)
                row = z[j] * n
                for k in range(j):
                    pairs += np.bincount(row + z[k], t[j] * t[k] / d, n * n)
        square = pairs.reshape(n, n)
        self.S = square + square.T + np.diag(own)

    def __call__(self, f_inv: F64) -> F64:
        """Return sum_z S(m, z) w(z) f^-1(z) / |E_m|, what `update` makes of `irradiance`."""
        with np.errstate(invalid="ignore"):
            return self.S @ (self.w * f_inv) / self.pixels


recover_steps = with_parts(__name__, robertson.recover_steps, alternate=Joint)


class Smooth:
    """`recover_steps` with a smoothness penalty, which connects levels that equal steps do not.

    After each iteration r = ln f^-1, less that of a linear camera, becomes the s of least sum (s -
    r)^2 + sum (lambda w s'')^2, r at the levels that have a mean. 100 is right for photographs.

    Examples
    --------
    >>> ramp = np.linspace(1, 100, 10_000).reshape(100, 100)  # a linear camera
    >>> images = np.clip(np.round(ramp * np.array([1, 2, 4])[:, None, None]), 0, 255).astype(np.uint8)
    >>> g = recover(images, [0.01, 0.02, 0.04], steps=Smooth(100))
    >>> bool(abs(g[200] - np.log(200 / 128)) < 0.01)
    True
    """

    def __init__(self, smoothness: float) -> None:
        if not 0 <= smoothness < np.inf:
            raise InputError(
                f"expected a smoothness that is finite and not negative, got {smoothness}"
            )
        self.smoothness = smoothness

    def __call__(
        self,
        Z: Indices,
        times: ArrayLike,
        w: F64,
        *,
        tolerance: float = 1e-4,
        max_iterations: int = 200,
    ) -> Iterator[robertson.State]:
        """Yield the States of one channel; parameters as of `recover_steps`."""
        matrix = None
        line = robertson.linear(len(w))

        def complete(means: F64, w: F64) -> F64:
            nonlocal matrix
            if matrix is None:  # which levels have a mean does not change
                matrix = _smoother(means, w, self.smoothness)
            return line * np.exp(matrix @ np.log(robertson.fill(means, w) / line))

        steps = with_parts(__name__, recover_steps, fill=complete)
        return steps(Z, times, w, tolerance=tolerance, max_iterations=max_iterations)


def _smoother(means: F64, w: F64, smoothness: float) -> F64:
    """Return the matrix from r (n,) to s."""
    level = np.arange(len(w))
    known = ~np.isnan(means) & (level > 0) & (level <= np.max(level[w > 0]))
    bends = weights.second_differences(w, smoothness)
    data = np.diag(np.where(known, 1.0, 1e-6))
    # symmetric, with five diagonals: the lower three are enough
    A = data + bends.T @ bends
    bands = [np.pad(np.diagonal(A, -k), (0, k)) for k in range(3)]
    return np.asarray(scipy.linalg.solveh_banded(bands, data, lower=True))


def _thinned(images: ArrayLike, count: int, *, valid: ArrayLike | None = None) -> Indices:
    """Return the samples of `by_rank`, from an even choice of the pixels."""
    stack = as_stack(images)
    pixel_count = stack.shape[1] * stack.shape[2]
    step = max(1, int(np.sqrt(pixel_count / max(RANKED_PIXELS, 4 * count))))
    grid = (slice(None), slice(step // 2, None, step), slice(step // 2, None, step))
    mask = as_mask(valid, stack)
    return sampling.by_rank(stack[grid], count, valid=None if mask is None else mask[grid])


def recover(
    images: ArrayLike,
    times: ArrayLike,
    *,
    samples: int = 4_000,
    w: ArrayLike | None = None,
    choose: Callable[..., Indices] = _thinned,
    valid: ArrayLike | None = None,
    steps: Callable[..., Iterator[robertson.State]] = recover_steps,
) -> F64:
    """Return the response g; the parameters are those of `response.robertson.recover`."""
    stack = as_stack(images)
    t = as_times(times, len(stack))
    return robertson.recover(
        stack, t, samples=samples, w=w, choose=choose, valid=valid, steps=steps
    )
