"""A camera's noise, from the bracket itself: two photographs of one light differ by chance.

x_j   estimate of frame j   X_j / t_j, the exposure of its level over its time: a radiance
E     radiance              (H, W, C), the map of these frames
y     relative difference   (x_j - x_k) / E of two frames that are neighbours in exposure
S     variance of y         over a group of flat pixels of similar radiance

Photon transfer needs an evenly lit wall (`capture.photon_transfer`). A bracket has flat parts of
many radiances instead, and each of them in neighbouring frames. The variances of the two add:

    S = a_1 / N + a_2 (R / N)^2 + a_3 rho^2 + a_0

where each a is a factor of `radiance.uncertainty.variance`, summed over the two frames. The fit is
of log S, because the error of a variance grows with it. Groups far off count little, because
something moved there. The mean of y measures errors of the response and the times, and of a camera
that processes each photo differently: its square, in the median group, adds to rho^2.
"""

from dataclasses import dataclass
from itertools import pairwise, product
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from hdrlab.core.arrays import F64, Array, ArrayLike, as_radiance
from hdrlab.diagnostics.warning_texts import warning_text
from hdrlab.errors import CalibrationError, InputError
from hdrlab.radiance.merge import CLIPPING_LEVEL, as_tables

# about this number of pixels of a channel is used, on an even grid
MAX_PIXELS = 400_000
# groups of pixels of similar radiance
GROUP_COUNT = 80
# pixels of a group without which its variance is not measured
MIN_PIXELS_PER_GROUP = 60
# groups without which the three parameters are not fitted
MIN_GROUPS = 6
# fraction of a group's pixels that counts as flat: those whose surroundings change least
FLAT_FRACTION = 0.4
# fraction of a group's flat pixels that both frames must measure: where some clip, the others
# scatter less
MIN_MEASURED_FRACTION = 0.99
# error of ln S for other reasons than the size of the group
MODEL_ERROR_LN = 0.1
# median of the square of a difference of two errors of variance 1
MEDIAN_SQUARED_DIFFERENCE = 0.91
# standard deviation over median absolute deviation, of a normal distribution
DEVIATION_PER_MAD = 1.4826
# where the fit may begin, and how far it may go: ln of 1 / N, (R / N)^2 and rho^2
LOG_STARTS = np.log([[1e-4, 1e-7, 1e-6], [1e-3, 1e-8, 1e-8], [1e-2, 1e-4, 1e-6]])
LOG_BOUNDS = np.log([[1e-9, 1e-16, 1e-12], [10.0, 10.0, 1.0]])


class Noise(NamedTuple):
    """The noise of each channel.

    Attributes
    ----------
    N : (C,) electrons at exposure X = 1
    R : (C,) read noise, electrons
    rho : (C,) relative error, a fraction of the radiance
    """

    N: F64
    R: F64
    rho: F64


@dataclass(frozen=True, kw_only=True)
class VarianceSample:
    """The variance S of a group in two frames, its parts, and the number of its pixels."""

    S: float
    squared_mean: float
    a0: float
    a1: float
    a2: float
    a3: float
    pixel_count: int


def estimate_noise(images: ArrayLike, times: ArrayLike, g: ArrayLike, E: ArrayLike) -> Noise:
    """Return the noise of a camera, from its bracket.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Aligned photographs, in any order; level 0 measures nothing.
    times : (P,) float
        Exposure times in seconds.
    g : (n,) or (n, 3) float
        Response, ln exposure of each level.
    E : (H, W) or (H, W, 3) float
        The radiance map of these photographs.

    Returns
    -------
    Noise
        The arguments of `radiance.uncertainty.merge_with_deviation`. Where rounding hides the
        noise, N is hardly known, and hardly matters.

    Raises
    ------
    InputError
        If the arrays do not fit together.
    CalibrationError
        If two photos measure too few flat pixels.

    References
    ----------
    Granados and others, Optimal HDR reconstruction with linear digital cameras, CVPR 2010, for the
    model.

    Examples
    --------
    >>> from hdrlab.capture import camera, responses
    >>> wall = np.geomspace(0.02, 1, 256 * 256).reshape(256, 256).astype(np.float32)
    >>> maker = camera.Camera(response="linear", bits=16, full_well=5000, read_noise=4)
    >>> taken = camera.shoot(wall, [0.25, 0.5, 1], maker, rng=1)
    >>> g = responses.true_g("linear", 65536)
    >>> noise = estimate_noise(taken.images, taken.times, g, 2 * wall)
    >>> bool(abs(noise.N[0] / 2500 - 1) < 0.1)  # half a well is X = 1
    True
    >>> bool(abs(noise.R[0] / 4 - 1) < 0.2)
    True
    """
    stack, t, _, curves, top = as_tables(images, times, g, None, "mean", CLIPPING_LEVEL)
    radiance = as_radiance(E).astype(np.float64)
    if radiance.shape != stack.shape[1:]:
        raise InputError(f"expected a map of shape {stack.shape[1:]}, got {radiance.shape}")
    Z = stack.reshape(*stack.shape[:3], -1)
    radiance = radiance.reshape(Z.shape[1:])
    step = max(1, int(np.sqrt(Z[0, ..., 0].size / MAX_PIXELS)))
    rows = slice(2, -2, step)
    columns = slice(2, -2, step)
    channels = []
    for c, curve in enumerate(curves.T):
        sample = radiance[rows, columns, c].ravel()
        steepness = slope(radiance[..., c])[::step, ::step].ravel()
        groups = group_flat(sample, steepness)
        levels = Z[:, rows, columns, c].reshape(len(t), -1)
        channels.append(_fit_channel(levels, t, curve, sample, groups, top))
    N, R, rho = np.array(channels).T
    return Noise(N, R, rho)


def slope(E: F64) -> F64:
    """Return how steeply E (H, W) changes around each pixel, relative to it, (H - 4, W - 4).

    The differences leave out the pixel itself, so that pixels with little noise are not preferred.
    """
    across = E[2:-2, 4:] - E[2:-2, :-4]
    down = E[4:, 2:-2] - E[:-4, 2:-2]
    return (np.abs(across) + np.abs(down)) / np.maximum(E[2:-2, 2:-2], 1e-12)


def group_flat(E: F64, steepness: F64) -> list[Array]:
    """Return the indices of the flattest pixels of each group of similar radiance."""
    groups = []
    for group in np.array_split(np.argsort(E, kind="stable"), GROUP_COUNT):
        if len(group):
            is_flat = steepness[group] <= np.quantile(steepness[group], FLAT_FRACTION)
            groups.append(group[is_flat])
    return groups


def scatter(y: F64) -> tuple[float, float]:
    """Return the variance of y and the square of its mean, without outliers.

    Outliers lie more than 4 robust deviations from the median: motion, and edges.
    """
    distances = np.abs(y - np.median(y))
    limit = 4 * max(DEVIATION_PER_MAD * np.median(distances), 0.5 * y.std())
    kept = y[distances <= limit]
    return float(kept.var()), float(kept.mean() ** 2)


def _fit_channel(
    Z: Array, t: F64, g: F64, E: F64, groups: list[Array], top: int
) -> tuple[float, float, float]:
    """Return N, R and rho of one channel, from levels Z (P, M) of radiance E (M,)."""
    X = np.exp(g)
    D = np.gradient(X)
    is_measured = (Z > 0) & (Z < top)
    neighbours = [list(pair) for pair in pairwise(np.argsort(t))]
    samples = []
    for group, frames in product(groups, neighbours):
        in_both = is_measured[frames][:, group].all(axis=0)
        is_enough = in_both.sum() >= MIN_PIXELS_PER_GROUP
        if is_enough and in_both.mean() >= MIN_MEASURED_FRACTION:
            pixels = group[in_both]
            sample = _measure_variance(Z[frames][:, pixels], t[frames], X, D, E[pixels])
            if sample.S > 0:
                samples.append(sample)
    if len(samples) < MIN_GROUPS:
        raise CalibrationError(warning_text("few", count=len(samples)))
    S = np.array([sample.S for sample in samples])
    squared_mean = np.array([sample.squared_mean for sample in samples])
    a0 = np.array([sample.a0 for sample in samples])
    a1 = np.array([sample.a1 for sample in samples])
    a2 = np.array([sample.a2 for sample in samples])
    a3 = np.array([sample.a3 for sample in samples])
    count = np.array([sample.pixel_count for sample in samples], np.float64)
    N, R, rho = _solve(S, a0, np.stack([a1, a2, a3]), count)
    # the mean of `count` differences is off by chance, too
    systematic = max(float(np.median(squared_mean - S / count)), 0.0)
    return N, R, np.sqrt(rho**2 + systematic / MEDIAN_SQUARED_DIFFERENCE)


def _measure_variance(Z: Array, t: F64, X: F64, D: F64, E: F64) -> VarianceSample:
    """Return the variance of pixels of radiance E (M,) that have levels Z (2, M) in two frames.

    X is the exposure of each level, D the width of a level's interval of exposures.
    """
    exposure = E * t[:, None]
    x = X[Z] / exposure
    rounding = (D[Z] / exposure) ** 2 / 12
    S, squared_mean = scatter(x[0] - x[1])
    return VarianceSample(
        S=S,
        squared_mean=squared_mean,
        a0=rounding.mean(axis=1).sum(),
        a1=(exposure**-1).mean(axis=1).sum(),
        a2=(exposure**-2).mean(axis=1).sum(),
        a3=2.0,
        pixel_count=Z.shape[1],
    )


def _solve(S: F64, a0: F64, a: F64, count: F64) -> tuple[float, float, float]:
    """Return N, R and rho of S = a_0 + a_1 / N + a_2 (R / N)^2 + a_3 rho^2.

    The solution is the least squares of log S.
    """
    sd = np.sqrt(2 / count + MODEL_ERROR_LN**2)

    def residual(p: F64) -> F64:
        return np.asarray(np.log((a0 + np.exp(p) @ a) / S) / sd, np.float64)

    fits = [
        least_squares(residual, start, bounds=LOG_BOUNDS, loss="soft_l1") for start in LOG_STARTS
    ]
    best = min(fits, key=lambda fit: float(fit.cost))
    inverse_N, squared_R_per_N, squared_rho = np.exp(best.x)
    return 1 / inverse_N, np.sqrt(squared_R_per_N) / inverse_N, np.sqrt(squared_rho)
