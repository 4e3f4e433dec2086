"""Wrong answers to tasks of homework 6. Each one breaks one sentence of its assignment, and no other.

A function's name begins with the id of its task.
"""

import numpy as np

from hdrlab.align.cerman import correlation, peaks
from hdrlab.beyond.assorted import reconstruct
from hdrlab.beyond.burst.temporal_merge import merge_tile, shrinkage
from hdrlab.beyond.splitter import join_sensors
from hdrlab.enhance.skin import distance, find_by_locus
from hdrlab.response.mann import descend
from hdrlab.response.selection import circle
from hdrlab.response.space import fit_space
from hdrlab.tonemap.brush import clip_histogram, equalise
from hdrlab.tonemap.drago import adaptive_log


def descend_low_ignored(T, start, *, low):
    return descend(T, start, low=0)


def correlation_divided_by_the_first_photo(X):
    return correlation(X) / np.nanstd(X[0])


def peaks_without_the_border(c, count):
    inner = np.zeros_like(c)
    inner[2:-2, 2:-2] = c[2:-2, 2:-2]
    return peaks(inner, count)


def peaks_one_alone(c, count):
    return peaks(c, 1)


def join_sensors_mean_far_from_full_pixels(B, D, full):
    E, case = join_sensors(B, D, full)
    return np.where(case == 1, (B + D) / 2, E), case


def join_sensors_B_among_full_pixels(B, D, full):
    E, case = join_sensors(B, D, full)
    return np.where(case == 4, B, E), case


def join_sensors_cases_from_0(B, D, full):
    E, case = join_sensors(B, D, full)
    return E, case.astype(int) - 1


def join_sensors_zeros_beyond_the_border(B, D, full):
    E, case = join_sensors(*(np.pad(one, 2) for one in (B, D, full)))
    return E[2:-2, 2:-2], case[2:-2, 2:-2]


def reconstruct_of_one_color(Z, e, c=None, **parameters):
    E = reconstruct(Z, e, **parameters)
    return E if c is None else np.stack([E] * 3, axis=-1)


def fit_space_mean_of_the_first_curve(curves, count):
    _, H, sd = fit_space(curves, count)
    return curves[0], H, sd


def clip_histogram_a_little_for_all(h, limit):
    return 0.99 * clip_histogram(h, limit=limit) + 0.01 / len(h)


def equalise_at_most_100(L, *, bins=256, limit=4.0):
    return equalise(np.minimum(L, np.float32(100)), bins=bins, limit=limit)


def circle_from_the_middle(A, B, **parameters):
    return circle(A, B, **parameters) / 2


def find_by_locus_black_is_skin(Z):
    return find_by_locus(Z) | (np.sum(Z, axis=-1) == 0)


def find_by_locus_lower_limit_alone(Z):
    with np.errstate(invalid="ignore", divide="ignore"):
        r, g, _ = np.moveaxis(Z / Z.sum(axis=-1, keepdims=True), -1, 0)
        not_gray = (r - 1 / 3) ** 2 + (g - 1 / 3) ** 2 > 0.0004
        return (g > -0.776 * r**2 + 0.5601 * r + 0.1766) & not_gray & (r > g)


def distance_of_red(Z, skin):
    return distance(np.stack([Z[..., 0], Z[..., 0], Z[..., 2]], axis=-1), skin)


def distance_dark_raised(Z, skin):
    return distance(np.maximum(Z, [1, 0, 0]), skin)


def distance_one_row(Z, skin):
    return distance(Z, skin).ravel()


def adaptive_log_always_bias_085(L, Lwa, Lmax, *, bias=0.85):
    return adaptive_log(L, Lwa, Lmax)


def adaptive_log_one_row(L, Lwa, Lmax, *, bias=0.85):
    return adaptive_log(np.ravel(L), Lwa, Lmax, bias=bias)


def merge_tile_difference_from_the_frame_before(T, variance, *, tuning):
    F = np.fft.fft2(T)
    D = np.concatenate([np.zeros_like(F[:1]), F[:-1] - F[1:]])
    A = shrinkage(D, variance, tuning)
    return np.fft.ifft2(np.mean(F + A * D, axis=0)).real


def merge_tile_always_8_pixels_wide(T, variance, *, tuning):
    return merge_tile(T, variance * 8**2 / np.shape(T)[-1] ** 2, tuning=tuning)


def merge_tile_always_12(T, variance, *, tuning):
    return merge_tile(T, variance, tuning=12.0)


def merge_tile_transform_returned(T, variance, *, tuning):
    return np.fft.fft2(merge_tile(T, variance, tuning=tuning)).real
