"""Known mistakes in `flat`, the task of hdrlab.response.selection.flat."""

import numpy as np
from scipy.ndimage import binary_erosion, uniform_filter
from scipy.stats import chi2, f

from hdrlab.course.checks.mistakes import mistake
from hdrlab.response.selection import Average, spatial_average, temporal_average, threshold


@mistake(
    "flat_noise_of_one_frame",
    says="You compare the average of t frames with the noise of one frame. The variance of the "
    "average is t times smaller.",
)
def noise_of_one_frame(A, *, size=5, psi=0.05, sigma=0.01):
    mean, variance, t = temporal_average(A, sigma=sigma)
    s = size**2
    estimated = s * (t - 1) if t > 1 else np.inf
    # as sigma_t is even over a flat patch, its s estimates are one
    noise = uniform_filter(variance, size)
    _, spread = spatial_average(mean, size=size)
    passed = s * spread <= threshold(s, psi=psi, estimated=estimated) * noise
    return passed & binary_erosion(np.ones(passed.shape), np.ones((3, 3)), iterations=size // 2)


@mistake(
    "flat_divided_by_t",
    says="You divide the sum of squares over t frames by t. Their mean uses up one degree of "
    "freedom, so divide by t - 1.",
)
def divided_by_t(A, *, size=5, psi=0.05, sigma=0.01):
    def temporal_average(A, *, sigma=0.01):
        A = np.asarray(A, np.float64)
        variance = A.var(axis=0) if len(A) > 1 else np.full(A.shape[1:], sigma**2)
        return Average(A.mean(axis=0), variance, len(A))

    mean, variance, t = temporal_average(A, sigma=sigma)
    s = size**2
    estimated = s * (t - 1) if t > 1 else np.inf
    # as sigma_t is even over a flat patch, its s estimates are one
    noise = uniform_filter(variance, size) / t
    _, spread = spatial_average(mean, size=size)
    passed = s * spread <= threshold(s, psi=psi, estimated=estimated) * noise
    return passed & binary_erosion(np.ones(passed.shape), np.ones((3, 3)), iterations=size // 2)


@mistake(
    "flat_edge_counts",
    says="At the edge of the image a patch is incomplete, so it cannot be tested. Return False "
    "there.",
)
def edge_counts(A, *, size=5, psi=0.05, sigma=0.01):
    mean, variance, t = temporal_average(A, sigma=sigma)
    s = size**2
    estimated = s * (t - 1) if t > 1 else np.inf
    # as sigma_t is even over a flat patch, its s estimates are one
    noise = uniform_filter(variance, size) / t
    _, spread = spatial_average(mean, size=size)
    passed = s * spread <= threshold(s, psi=psi, estimated=estimated) * noise
    return passed


@mistake(
    "flat_other_tail",
    says="Your limit is the lower quantile psi of the noise. Use the upper one: isf(psi), "
    "which is ppf(1 - psi).",
)
def other_tail(A, *, size=5, psi=0.05, sigma=0.01):
    def threshold(s=25, *, psi=0.05, estimated=np.inf):
        return float(
            chi2.ppf(psi, s - 1) if np.isinf(estimated) else (s - 1) * f.ppf(psi, s - 1, estimated)
        )

    mean, variance, t = temporal_average(A, sigma=sigma)
    s = size**2
    estimated = s * (t - 1) if t > 1 else np.inf
    # as sigma_t is even over a flat patch, its s estimates are one
    noise = uniform_filter(variance, size) / t
    _, spread = spatial_average(mean, size=size)
    passed = s * spread <= threshold(s, psi=psi, estimated=estimated) * noise
    return passed & binary_erosion(np.ones(passed.shape), np.ones((3, 3)), iterations=size // 2)
