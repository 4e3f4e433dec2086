"""Wrong answers to tasks of homework 3. Each one breaks one sentence of its assignment, and no other.

A function's name begins with the id of its task.
"""

import numpy as np
from scipy import ndimage

from hdrlab.io.maps.exr import decode_half
from hdrlab.io.maps.pfm import from_bytes, to_bytes
from hdrlab.io.maps.rgbe import to_pixels, to_radiance
from hdrlab.radiance.deghosting.deviation import weighted_variance
from hdrlab.radiance.deghosting.regions import dilate, find_seeds, label
from hdrlab.radiance.merge import bound, merge
from hdrlab.radiance.ratios import ratio_steps


def merge_of_each_photo(images, times, g, w=None):
    return np.stack([merge(image[None], [t], g, w) for image, t in zip(images, times, strict=True)])


def merge_stays_a_logarithm(images, times, g, w=None):
    return np.log(merge(images, times, g, w))


def merge_sorts_the_times_alone(images, times, g, w=None):
    return merge(images, np.sort(times), g, w)


def bound_of_flags_alone(Z, B, g, top, shown):
    return bound(Z, B, g, top, shown)[1]


def bound_nan_without_bounds(Z, B, g, top, shown):
    E, flags = bound(Z, B, g, top, shown)
    return np.where(E > 0, E, np.nan), flags


def bound_above_top_alone(Z, B, g, top, shown):
    return bound(np.where(Z == top, top - 1, Z), B, g, top, shown)


def bound_sorts_the_times_alone(Z, B, g, top, shown):
    return bound(Z, np.sort(B), g, top, shown)


def bound_flags_of_hidden_photos(Z, B, g, top, shown):
    E, _ = bound(Z, B, g, top, shown)
    _, flags = bound(Z, B, g, top, np.ones(Z.shape, bool))
    return E, flags


def to_bytes_always_color(E):
    return to_bytes(E).replace(b"Pf", b"PF", 1)


def to_bytes_sign_forgotten(E):
    return to_bytes(E).replace(b"-1.0", b"1.0", 1)


def to_bytes_magnitude_left_out(E):
    return to_bytes(E).replace(b"-1.0", b"-", 1)


def from_bytes_of_gray_alone(data):
    E = from_bytes(data)
    return E if E.ndim == 2 else E[..., 0]


def to_pixels_exponent_first(E):
    return np.roll(to_pixels(E), 1, axis=-1)


def to_pixels_black_has_an_exponent(E):
    pixels = to_pixels(E)
    pixels[E.max(axis=-1) == 0, 3] = 128
    return pixels


def to_radiance_keeps_the_exponent(pixels):
    return np.concatenate([to_radiance(pixels), pixels[..., 3:]], axis=-1)


def decode_half_infinity_is_a_number(bits):
    e = bits.astype(int) >> 10 & 31
    return np.where(e == 31, np.where(bits >> 15, -65536.0, 65536.0), decode_half(bits))


def decode_half_infinity_without_sign(bits):
    values = decode_half(bits)
    return np.where(np.isinf(values), np.inf, values)


def decode_half_in_one_row(bits):
    return decode_half(bits).ravel()[None, None]


def weighted_variance_nan_without_weights(x, w):
    return np.where(w.sum(axis=0) > 0, weighted_variance(x, w), np.nan)


def find_seeds_of_1(score):
    return find_seeds(score * 1.0001)


def find_seeds_at_the_border(score):
    return find_seeds(np.pad(score, 1, mode="edge"))[1:-1, 1:-1]


def find_seeds_not_at_the_border(score):
    mask = find_seeds(score)
    mask[[0, -1]] = False
    mask[:, [0, -1]] = False
    return mask


def dilate_of_an_empty_mask(mask, margin):
    # scipy measures the distance from pixels that do not exist
    return ndimage.binary_fill_holes(ndimage.distance_transform_edt(~mask) <= margin)


def dilate_empty_mask_is_full(mask, margin):
    return dilate(mask, margin) if mask.any() else ~mask


def dilate_holes_leak_at_corners(mask, margin):
    near = ndimage.distance_transform_edt(~mask) <= margin if mask.any() else mask
    return ndimage.binary_fill_holes(near, np.ones((3, 3)))


def label_with_gaps(mask):
    return 2 * label(mask)


def label_of_the_background(mask):
    labels = label(mask)
    return np.where(mask, labels, labels.max() + 1)


def ratio_steps_start_left_out(found, *, limit=9.0, tolerance=1e-06, rounds=100):
    yield from list(ratio_steps(found, limit=limit, tolerance=tolerance, rounds=rounds))[1:]


def ratio_steps_always_all_rounds(found, *, limit=9.0, tolerance=1e-06, rounds=100):
    yield from ratio_steps(found, limit=limit, tolerance=-1.0, rounds=rounds)


def ratio_steps_default_limit(found, *, limit=9.0, tolerance=1e-06, rounds=100):
    yield from ratio_steps(found, tolerance=tolerance, rounds=rounds)


def ratio_steps_sum_of_errors(found, *, limit=9.0, tolerance=1e-06, rounds=100):
    for k, used, V in ratio_steps(found, limit=limit, tolerance=tolerance, rounds=rounds):
        yield k, used, V * used.sum()


def to_bytes_as_text(E):
    return to_bytes(E).decode("latin1")


def to_pixels_of_fractions(E):
    return to_pixels(E) / 256
