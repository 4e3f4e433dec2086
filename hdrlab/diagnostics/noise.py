"""A camera's noise, from the bracket itself: two photographs of one light differ by chance.

x_j   answer of frame j   X_j / t_j, the exposure of its level over its time: a radiance
E     radiance            (H, W, C), the map of these frames
y     of two frames       (x_j - x_k) / E, what neighbours in exposure contradict each other by
S     of a group          the variance of y, over pixels that are flat and of like light

Photon transfer wants an evenly lit wall (`capture.photon_transfer`); a bracket has flat parts of
many lights
instead, and each of them in neighbouring frames. The variances of the two add:

    S = a_1 / N + a_2 (R / N)^2 + a_3 rho^2 + a_0

where each a is what `radiance.uncertainty.variance` multiplies there, summed over the two. What is
fitted is log S, for the error of a variance grows with it, and groups far off count little: there
something moved. The mean of y tells how response and times err, or how a camera treats each
photograph in its own way: its square, in the median group, adds to rho^2.
"""

from itertools import pairwise, product
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from hdrlab.core.arrays import F64, Array, ArrayLike, as_radiance
from hdrlab.diagnostics.doubts import warning_text
from hdrlab.errors import CalibrationError, InputError
from hdrlab.radiance.merge import CLIPPING_LEVEL, as_tables

# of a channel, on an even grid, that stand for all
PIXELS = 400_000
# groups of like light, and pixels of one that make a mean square
GROUPS, FEWEST = 80, 60
# of a group, those whose surroundings change least
FLAT = 0.4
# ln S by which a group may err for other reasons than that it is small
MODEL = 0.1
# of the square of a difference of two errors of variance 1: its median
MEDIAN = 0.91
# from where the fit may begin, and how far it may go: ln of 1 / N, (R / N)^2 and rho^2
STARTS = np.log([[1e-4, 1e-7, 1e-6], [1e-3, 1e-8, 1e-8], [1e-2, 1e-4, 1e-6]])
LIMITS = np.log([[1e-9, 1e-16, 1e-12], [10.0, 10.0, 1.0]])


class Noise(NamedTuple):
    """Of each channel (C,): electrons at X = 1, read noise in electrons, and rho, the share of the light."""

    N: F64
    R: F64
    rho: F64


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
        What `radiance.uncertainty.merge_with_deviation` takes. Where rounding hides the noise, N is
        hardly known, and hardly matters.

    Raises
    ------
    ValueError
        For arrays that do not fit together, and where too little is flat and measured by two
        photographs.

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
    >>> found = estimate_noise(taken.images, taken.times, responses.true_g("linear", 65536), 2 * wall)
    >>> bool(abs(found.N[0] / 2500 - 1) < 0.1), bool(abs(found.R[0] / 4 - 1) < 0.2)  # half a well is X = 1
    (True, True)
    """
    stack, t, _, curves, top = as_tables(images, times, g, None, "mean", CLIPPING_LEVEL)
    light, Z = as_radiance(E).astype(np.float64), stack.reshape(*stack.shape[:3], -1)
    if light.shape != stack.shape[1:]:
        raise InputError(f"expected a map of shape {stack.shape[1:]}, got {light.shape}")
    every, found = max(1, int(np.sqrt(Z[0, ..., 0].size / PIXELS))), []
    few = np.s_[2:-2:every, 2:-2:every]
    for c, curve in enumerate(curves.T):
        plane = light.reshape(Z.shape[1:])[..., c]
        groups = group_flat(plane[few].ravel(), slope(plane)[::every, ::every].ravel())
        levels = Z[(slice(None), *few, c)].reshape(len(t), -1)
        found.append(_fit(levels, t, curve, plane[few].ravel(), groups, top))
    return Noise(*np.array(found).T)


def slope(E: F64) -> F64:
    """Return how steeply E (H, W) changes around each pixel, as a share of it, (H - 4, W - 4).

    The pixel itself has no say, so that those with little noise are not preferred.
    """
    across, down = E[2:-2, 4:] - E[2:-2, :-4], E[4:, 2:-2] - E[:-4, 2:-2]
    return (np.abs(across) + np.abs(down)) / np.maximum(E[2:-2, 2:-2], 1e-12)


def group_flat(E: F64, rough: F64) -> list[Array]:
    """Return the indices of the flattest pixels of each of GROUPS groups of like light."""
    rising = [one for one in np.array_split(np.argsort(E, kind="stable"), GROUPS) if len(one)]
    return [one[rough[one] <= np.quantile(rough[one], FLAT)] for one in rising]


def scatter(y: F64) -> tuple[float, float]:
    """Return the variance of y and the square of its mean, without what lies far from the median.

    Far are 4 deviations of the middle half: what moved, and edges.
    """
    far = np.abs(y - np.median(y))
    kept = y[far <= 4 * max(1.4826 * np.median(far), 0.5 * y.std())]
    return float(kept.var()), float(kept.mean() ** 2)


def _fit(
    Z: Array, t: F64, g: F64, E: F64, groups: list[Array], top: int
) -> tuple[float, float, float]:
    """Return N, R and rho of one channel, from levels Z (P, M) of the light E (M,)."""
    X, measured, rows = np.exp(g), (Z > 0) & (Z < top), []
    D = np.gradient(X)
    for flat, two in product(groups, map(list, pairwise(np.argsort(t)))):
        both = measured[two][:, flat].all(axis=0)
        if both.sum() < FEWEST or both.mean() < 0.99:  # where some clip, the rest scatter less
            continue
        pixels = flat[both]
        Et, level = E[pixels] * t[two, None], Z[two][:, pixels]
        x, rounding = X[level] / Et, (D[level] / Et) ** 2 / 12
        a = [(Et**-power).mean(axis=1).sum() for power in (1, 2)]
        rows.append([*scatter(x[0] - x[1]), rounding.mean(axis=1).sum(), *a, 2.0, len(pixels)])
    S, bias, a0, *a, count = np.array([row for row in rows if row[0] > 0]).reshape(-1, 7).T
    if len(S) < 6:
        raise CalibrationError(warning_text("few", count=len(S)))
    N, R, rho = _solve(S, a0, np.array(a), count)
    return N, R, np.sqrt(rho**2 + max(float(np.median(bias - S / count)), 0.0) / MEDIAN)


def _solve(S: F64, a0: F64, a: F64, count: F64) -> tuple[float, float, float]:
    """Return N, R and rho of S = a_0 + a_1 / N + a_2 (R / N)^2 + a_3 rho^2, by least squares of log S."""
    sd = np.sqrt(2 / count + MODEL**2)

    def residual(p: F64) -> F64:
        return np.asarray(np.log((a0 + np.exp(p) @ a) / S) / sd, np.float64)

    fits = [least_squares(residual, start, bounds=LIMITS, loss="soft_l1") for start in STARTS]
    one, two, three = np.exp(min(fits, key=lambda fit: float(fit.cost)).x)
    return 1 / one, np.sqrt(two) / one, np.sqrt(three)
