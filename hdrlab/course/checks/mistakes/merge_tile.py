"""Known mistakes in `merge_tile`, the task of hdrlab.beyond.burst.temporal_merge.merge_tile."""

import numpy as np

from hdrlab.beyond.burst import temporal_merge
from hdrlab.course.checks.mistakes import mistake


@mistake(
    "merge_tile_shrinkage_swapped",
    says="Your shrinkage works the wrong way around: it keeps a frame where it differs most. A near 1 "
    "means motion, and there F_z + A D_z must be F_0, with D_z = F_0 - F_z.",
    misses_method=True,
)
def shrinkage_swapped(T, variance, *, tuning):
    F = np.fft.fft2(T)
    D = F[0] - F
    A = temporal_merge.shrinkage(D, variance, tuning)
    return np.fft.ifft2(np.mean(F[0] - A * D, axis=0)).real


@mistake(
    "merge_tile_in_pixels",
    says="You compare pixels. Compare Fourier coefficients: transform the tiles first, compute D and "
    "A for each frequency, and transform the mean back.",
    misses_method=True,
)
def in_pixels(T, variance, *, tuning):
    T = np.asarray(T, np.float64)
    D = T[0] - T
    A = D**2 / (D**2 + tuning * 2 * variance)
    return np.mean(T + A * D, axis=0)


@mistake(
    "merge_tile_without_the_number_of_pixels",
    says="Your S is too small: a Fourier coefficient is a sum over all n * n pixels of the tile, so "
    "S = 2 n^2 variance.",
)
def without_the_number_of_pixels(T, variance, *, tuning):
    side = np.shape(T)[-1]
    return temporal_merge.merge_tile(T, variance / side**2, tuning=tuning)


@mistake(
    "merge_tile_noise_of_one_frame",
    says="Your S is half of what it should be. A difference contains the noise of two tiles: S = 2 n^2 "
    "variance.",
)
def noise_of_one_frame(T, variance, *, tuning):
    return temporal_merge.merge_tile(T, variance / 2, tuning=tuning)


@mistake(
    "merge_tile_without_the_reference",
    says="Your mean has N - 1 terms. The reference frame is one of the N frames: its D is 0, and its "
    "term is F_0.",
)
def without_the_reference(T, variance, *, tuning):
    F = np.fft.fft2(T)
    D = F[0] - F[1:]
    A = temporal_merge.shrinkage(D, variance, tuning)
    return np.fft.ifft2(np.mean(F[1:] + A * D, axis=0)).real


@mistake(
    "merge_tile_one_shrinkage_for_all",
    says="You use one A for the whole tile, so a single moving edge rejects all of it. Compute A for "
    "each frequency: an array of the shape of D.",
)
def one_shrinkage_for_all(T, variance, *, tuning):
    F = np.fft.fft2(T)
    D = F[0] - F
    power = np.mean(np.abs(D) ** 2, axis=(-2, -1), keepdims=True)
    expected = tuning * 2 * np.shape(T)[-1] ** 2 * variance
    return np.fft.ifft2(np.mean(F + power / (power + expected) * D, axis=0)).real
