"""One response curve, and how far each channel departs from it.

c     (K,)    coefficients of the shared curve in the space of responses, see `response.space`
d     (K,)    departure of a channel: its coefficients are c + d
A, b          equations of a channel: |A (c + d) - b|^2, see `response.space.build_equations`
D             departure of each dark pixel value: D d, in ln exposure
tau           how far channels depart, as a fraction of how far the curves of cameras do

All channels together determine c. Each channel determines its own d, as far as its pixels are worth
more than the prior d ~ Normal(0, tau sd). tau = 0 is one curve for all channels, and a large tau is
a curve for each. In between, the pixels decide: where they say little, the channels stay together.

Below pixel value 8, pixels say little: noise, rounding and compression decide what a photo shows.
A second prior, D d ~ Normal(0, 0.1 tau), ties the channels there. Otherwise their curves drift apart,
and the dark part of a night has colors that nobody saw.
"""

import numpy as np

from hdrlab.core import sampling, weights
from hdrlab.core.arrays import F64, ArrayLike, as_stack, as_times
from hdrlab.errors import InputError
from hdrlab.response import space

# standard deviation of ln exposure at the pixel value of the largest weight, as in `space.recover`
LOG_EXPOSURE_DEVIATION = 0.02
# pixel values below which noise and rounding decide
FIRST_MEASURED_LEVEL = 8
# standard deviation of the departure of these pixel values, ln exposure, for tau = 1
DARK_DEPARTURE = 0.1
# pixels that are chosen in each channel
SAMPLE_COUNT = 1000


def recover(
    images: ArrayLike, times: ArrayLike, *, departure: float, valid: ArrayLike | None = None
) -> F64:
    """Return the most likely response g of each channel, with a prior that ties the channels.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Aligned photos.
    times : (P,) float
        Exposure times in seconds.
    departure : float
        tau, positive.
    valid : (P, H, W) bool, optional
        False where a photo has no image.

    Returns
    -------
    (256,) or (256, 3) float64
        ln exposure of each pixel value; g[128] = 0 in every channel.

    Raises
    ------
    InputError
        If tau is not positive, or no pixel is well exposed in two photos.

    Examples
    --------
    >>> ramp = np.linspace(1, 100, 10_000).reshape(100, 100, 1)  # a linear camera
    >>> exposures = ramp * np.array([1, 2, 4])[:, None, None, None] * np.ones(3)
    >>> images = np.clip(np.round(exposures), 0, 255).astype(np.uint8)
    >>> g = recover(images, [0.01, 0.02, 0.04], departure=0.1)
    >>> bool(np.all(np.abs(g[200] - np.log(200 / 128)) < 0.02))
    True
    """
    if not 0 < departure < np.inf:
        raise InputError(f"expected a positive departure, got {departure}")
    stack = as_stack(images)
    log_times = np.log(as_times(times, len(stack), distinct=2))
    basis = space.default_space()
    level_weights = weights.cut(weights.hat())
    level_weights = level_weights / level_weights.max()
    samples = sampling.by_rank(stack, SAMPLE_COUNT, valid=valid)
    normal_matrices = []
    right_sides = []
    for Z in sampling.split_channels(samples):
        A, b = space.build_equations(Z, log_times, level_weights, basis)
        normal_matrices.append(A.T @ A / LOG_EXPOSURE_DEVIATION**2)
        right_sides.append(A.T @ b / LOG_EXPOSURE_DEVIATION**2)
    D = basis.H[:, :FIRST_MEASURED_LEVEL].T
    precision = np.diag(1 / basis.sd**2) + D.T @ D / DARK_DEPARTURE**2
    coefficients = _solve(normal_matrices, right_sides, basis.sd, precision / departure**2)
    g = space.reconstruct(coefficients, basis).T
    return weights.make_monotone(g - g[128]).reshape(256, *stack.shape[3:])


def _solve(normal_matrices: list[F64], right_sides: list[F64], sd: F64, precision: F64) -> F64:
    """Return the coefficients c + d of each channel, (C, K).

    `precision` (K, K) is the inverse covariance of the prior of d.
    """
    count = len(sd)
    size = count * (1 + len(normal_matrices))
    matrix = np.zeros((size, size))
    right_side = np.zeros(size)
    shared = slice(0, count)
    matrix[shared, shared] = np.diag(1 / sd**2)
    for channel, (normal_matrix, channel_side) in enumerate(
        zip(normal_matrices, right_sides, strict=True)
    ):
        own = slice(count * (channel + 1), count * (channel + 2))
        matrix[shared, shared] += normal_matrix
        matrix[shared, own] = normal_matrix
        matrix[own, shared] = normal_matrix
        matrix[own, own] = normal_matrix + precision
        right_side[shared] += channel_side
        right_side[own] = channel_side
    solution = np.linalg.solve(matrix, right_side).reshape(-1, count)
    return solution[1:] + solution[0]
