"""Wrong answers to tasks of homework 1. Each one breaks one sentence of its assignment, and no other.

A function's name begins with the id of its task.
"""

import math

import numpy as np

from hdrlab.align.mtb import align, shrink, threshold
from hdrlab.align.shift import shift
from hdrlab.capture.exposure import ev


def ev_of_the_first_time(F, T, S=100.0):
    return ev(F, np.ravel(T)[0], S=S)


def count_below_1(scene, usable, overlap):
    return 1 + math.ceil((scene - usable) / (usable - overlap))


def threshold_of_the_first_fraction(h, q):
    return threshold(h, np.ravel(q)[0])


def threshold_one_too_high(h, q):
    return threshold(h, q) + 1


def exclusion_as_distance(Y, t):
    return np.abs(Y.astype(int) - t)


def shrink_pads_an_odd_side(Y):
    return shrink(np.pad(Y, ((0, len(Y) % 2), (0, Y.shape[1] % 2)), mode="edge"))


def shift_of_the_first_channel(images, offsets):
    images = np.asarray(images)
    return shift(images[..., 0] if images.ndim == 4 else images, offsets)


def shift_crops_at_least_one_pixel(images, offsets):
    moved = shift(images, offsets)
    return moved if np.any(offsets) else moved[:, 1:-1, 1:-1]


def align_always_one_more(images, *, bits=6):
    offsets = align(images, bits=bits)
    offsets[-1] += 1
    return offsets


def align_never_moves(images, *, bits=6):
    return np.zeros((len(images), 2), int)


def align_onto_the_image_in_the_middle_of_the_list(images, *, bits=6):
    offsets = align(images, bits=bits)
    return offsets - offsets[len(offsets) // 2]


def align_of_three_levels(images, *, bits=6):
    return align(images, bits=min(bits, 3))


def shrink_keeps_the_size(Y):
    return np.repeat(np.repeat(shrink(Y), 2, axis=0), 2, axis=1)
