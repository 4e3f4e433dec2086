"""Checks of merge_tile(T, variance, tuning), the Wiener merge of the aligned tiles of a burst: (n, n)."""

import numpy as np

from hdrlab.beyond.burst import temporal_merge
from hdrlab.course.checks.compare import points, same

COUNT = 6
SIDE = 8


def is_valid_input(T, variance, tuning):
    """Return whether T are square tiles, and the numbers are positive."""
    is_stack = np.ndim(T) == 3 and np.shape(T)[1] == np.shape(T)[2] and len(T) > 0
    return is_stack and variance > 0 and tuning > 0


def draw_tiles(rng, *, count=COUNT, side=SIDE, sigma=1.0):
    """Return tiles (N, n, n) of the same texture, with noise."""
    return rng.uniform(20, 80, (side, side)) + sigma * rng.standard_normal((count, side, side))


def agree(subject, T, variance, tuning, tolerance, *, what="the merged tile"):
    expected = temporal_merge.merge_tile(T, variance, tuning=tuning)
    answer = subject.merge_tile(T, variance, tuning=tuning)
    same(answer, expected, tolerance, what=what, kind="image")


@points(4)
def test_equal_tiles_give_the_same_tile(subject, rng):
    """All frames are equal. What is D?

    D is 0, so each term of the sum is F_z = F_0, and their mean is F_0.

    Transform back, and return the real part, (n, n).
    """
    tile = rng.uniform(20, 80, (SIDE, SIDE))
    T = np.stack([tile] * COUNT)
    answer = subject.merge_tile(T, 1.0, tuning=12.0)
    same(answer, tile, 1e-3, what="the merged tile", kind="image")


@points(4)
def test_motion_leaves_the_reference_alone(subject, rng):
    """The other frames show something else, far beyond the noise. What should be left of them?

    |D|^2 is far larger than c S, so A is 1, and F_z + A D_z is F_0.

    The first tile is the reference: D_z = F_0 - F_z. The sign matters.
    """
    T = rng.uniform(0, 1, (COUNT, SIDE, SIDE)) * 100
    answer = subject.merge_tile(T, 1e-6, tuning=0.1)
    same(answer, T[0], 0.05, what="the merged tile", kind="image")


@points(2)
def test_a_large_tuning_constant_gives_the_mean_of_all_frames(subject, rng):
    """With a very large c, A is 0 everywhere. What is the sum then?

    The sum of all F_z: the mean of the tiles.

    The reference is one of the N frames, and counts as well.
    """
    T = draw_tiles(rng, sigma=rng.uniform(3, 6))
    answer = subject.merge_tile(T, 10.0, tuning=1e9)
    same(answer, T.mean(axis=0), 0.01, what="the merged tile", kind="image")


@points(3)
def test_the_noise_of_a_difference_is_2_n_squared_variance(subject, rng):
    """When is a difference as large as noise?

    A Fourier coefficient is a sum over n^2 pixels, so its noise is n^2 sigma^2. D is a difference of
    two.

    S = 2 n^2 variance, with n from the tiles: another side has another S.
    """
    sigma = rng.uniform(0.8, 1.2)
    for side in (8, 12):
        T = draw_tiles(rng, side=side, sigma=sigma)
        agree(subject, T, sigma**2, 3.0, 2e-3 * sigma)


@points(2)
def test_each_frequency_has_its_own_shrinkage(subject, rng):
    """A single wave differs, far beyond the noise. All other frequencies of the frames agree up to noise.

    The wave is left out, but only the wave: A is large at two frequencies, and small at all others.

    A is an array with the shape of D, and no single number.
    """
    T = draw_tiles(rng, sigma=1.0)
    x = np.arange(SIDE)
    wave = 3e4 * np.cos(2 * np.pi * 2 * x / SIDE + rng.uniform(0, 1))
    T[1:] += wave
    agree(subject, T, 1e3, 12.0, 0.1)
