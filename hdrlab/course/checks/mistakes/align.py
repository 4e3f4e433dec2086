"""Known mistakes in `align`, the task of hdrlab.align.mtb.align."""

from itertools import pairwise

import numpy as np

from hdrlab.align.mtb import (
    MIN_SIDE_PIXELS,
    NINE_OFFSETS,
    State,
    align_steps,
    bitmaps,
    by_brightness,
    chain_offsets,
    gray,
    shrink,
    step,
)
from hdrlab.course.checks.mistakes import Question, mistake


@mistake(
    "align_not_doubled",
    says="A pixel of one level is two pixels of the next finer level. Double the offset before "
    "you search around it.",
)
def not_doubled(images, *, bits=6, luma=False):
    def search(fixed, moving, *, bits=6, q=0.5):
        pyramid = [(fixed, moving)]
        while len(pyramid) < bits and min(pyramid[-1][0].shape) >= MIN_SIDE_PIXELS:
            pyramid.append((shrink(pyramid[-1][0]), shrink(pyramid[-1][1])))
        offset = (0, 0)
        for level in reversed(range(len(pyramid))):
            A, B = (bitmaps(Y, q) for Y in pyramid[level])
            errors = step(A, B, offset)
            offset = min(errors, key=errors.__getitem__)
            yield State(level, A, B, errors, offset)

    def align_steps(images, *, bits=6, luma=False):
        images = np.asarray(images)
        for moving, fixed in pairwise(by_brightness(images)):
            yield from search(
                gray(images[fixed], luma=luma), gray(images[moving], luma=luma), bits=bits
            )

    pair_offsets = [
        state.offset for state in align_steps(images, bits=bits, luma=luma) if state.level == 0
    ]
    return chain_offsets(by_brightness(np.asarray(images)), pair_offsets)


@mistake(
    "align_ties_from_the_corner",
    says="When all nine candidates are equally good, you take the first one, in the corner, and "
    "drift by a pixel per level. Prefer the center.",
    questions=(
        Question(
            code="Y = np.random.default_rng(1).integers(0, 256, (32, 32), np.uint8)\n"
            "np.abs(align(np.stack([Y, Y]), bits=1)).max()",
            why="Both images are the same, and they have texture. Only the offset (0, 0) "
            "makes all bits agree.",
            because="Take the offset with the smallest",
        ),
        Question(
            code="images = np.full((2, 32, 32), 100, np.uint8)\n"
            "np.abs(align(images, bits=1)).max()",
            why="All pixels are equal, so the nine offsets are equally good. The center is (0, 0).",
            because="In a tie, the center wins",
        ),
        Question(
            code="images = np.full((2, 32, 32), 100, np.uint8)\n"
            "np.abs(align(images, bits=2)).max()",
            why="The same on two levels. On each of them, the center wins.",
            because="In a tie, the center wins",
        ),
    ),
)
def ties_from_the_corner(images, *, bits=6, luma=False):
    def search(fixed, moving, *, bits=6, q=0.5):
        pyramid = [(fixed, moving)]
        while len(pyramid) < bits and min(pyramid[-1][0].shape) >= MIN_SIDE_PIXELS:
            pyramid.append((shrink(pyramid[-1][0]), shrink(pyramid[-1][1])))
        offset = (0, 0)
        for level in reversed(range(len(pyramid))):
            A, B = (bitmaps(Y, q) for Y in pyramid[level])
            errors = step(A, B, (2 * offset[0], 2 * offset[1]))
            offset = min(sorted(errors), key=errors.__getitem__)
            yield State(level, A, B, errors, offset)

    def align_steps(images, *, bits=6, luma=False):
        images = np.asarray(images)
        for moving, fixed in pairwise(by_brightness(images)):
            yield from search(
                gray(images[fixed], luma=luma), gray(images[moving], luma=luma), bits=bits
            )

    pair_offsets = [
        state.offset for state in align_steps(images, bits=bits, luma=luma) if state.level == 0
    ]
    return chain_offsets(by_brightness(np.asarray(images)), pair_offsets)


@mistake(
    "align_bitmap_made_small",
    says="You compute the bitmap of the full image and shrink the bitmap. Shrink the image "
    "first; otherwise fine texture becomes noise at the coarse levels.",
)
def bitmap_made_small(images, *, bits=6, luma=False):
    def search(fixed, moving, *, bits=6, q=0.5):
        pyramid = [(fixed, moving)]
        while len(pyramid) < bits and min(pyramid[-1][0].shape) >= MIN_SIDE_PIXELS:
            pyramid.append((shrink(pyramid[-1][0]), shrink(pyramid[-1][1])))
        offset = (0, 0)
        for level in reversed(range(len(pyramid))):
            A, B = (bitmaps(Y, q)[:, :: 2**level, :: 2**level] for Y in pyramid[0])
            errors = step(A, B, (2 * offset[0], 2 * offset[1]))
            offset = min(errors, key=errors.__getitem__)
            yield State(level, A, B, errors, offset)

    def align_steps(images, *, bits=6, luma=False):
        images = np.asarray(images)
        for moving, fixed in pairwise(by_brightness(images)):
            yield from search(
                gray(images[fixed], luma=luma), gray(images[moving], luma=luma), bits=bits
            )

    pair_offsets = [
        state.offset for state in align_steps(images, bits=bits, luma=luma) if state.level == 0
    ]
    return chain_offsets(by_brightness(np.asarray(images)), pair_offsets)


@mistake(
    "align_coarsest_level_forgotten",
    says="Your pyramid has one level too few. With `bits` levels, an offset reaches 2^bits - 1 "
    "pixels.",
)
def coarsest_level_forgotten(images, *, bits=6, luma=False):
    def search(fixed, moving, *, bits=6, q=0.5):
        pyramid = [(fixed, moving)]
        while len(pyramid) < bits - 1 and min(pyramid[-1][0].shape) >= MIN_SIDE_PIXELS:
            pyramid.append((shrink(pyramid[-1][0]), shrink(pyramid[-1][1])))
        offset = (0, 0)
        for level in reversed(range(len(pyramid))):
            A, B = (bitmaps(Y, q) for Y in pyramid[level])
            errors = step(A, B, (2 * offset[0], 2 * offset[1]))
            offset = min(errors, key=errors.__getitem__)
            yield State(level, A, B, errors, offset)

    def align_steps(images, *, bits=6, luma=False):
        images = np.asarray(images)
        for moving, fixed in pairwise(by_brightness(images)):
            yield from search(
                gray(images[fixed], luma=luma), gray(images[moving], luma=luma), bits=bits
            )

    pair_offsets = [
        state.offset for state in align_steps(images, bits=bits, luma=luma) if state.level == 0
    ]
    return chain_offsets(by_brightness(np.asarray(images)), pair_offsets)


@mistake(
    "align_nothing_excluded",
    says="You also count pixels near the median, whose bits are noise. AND the differences "
    "with both exclusion bitmaps.",
)
def nothing_excluded(images, *, bits=6, luma=False):
    def error(fixed, moving, offset):
        dy, dx = offset
        H, W = fixed.shape[1:]
        A, A_kept = fixed[:, max(dy, 0) : max(H + dy, 0), max(dx, 0) : max(W + dx, 0)]
        B, B_kept = moving[:, max(-dy, 0) : max(H - dy, 0), max(-dx, 0) : max(W - dx, 0)]
        return float((A ^ B).mean())

    def step(fixed, moving, offset):
        near = [(offset[0] + dy, offset[1] + dx) for dy, dx in NINE_OFFSETS]
        return {candidate: error(fixed, moving, candidate) for candidate in near}

    def search(fixed, moving, *, bits=6, q=0.5):
        pyramid = [(fixed, moving)]
        while len(pyramid) < bits and min(pyramid[-1][0].shape) >= MIN_SIDE_PIXELS:
            pyramid.append((shrink(pyramid[-1][0]), shrink(pyramid[-1][1])))
        offset = (0, 0)
        for level in reversed(range(len(pyramid))):
            A, B = (bitmaps(Y, q) for Y in pyramid[level])
            errors = step(A, B, (2 * offset[0], 2 * offset[1]))
            offset = min(errors, key=errors.__getitem__)
            yield State(level, A, B, errors, offset)

    def align_steps(images, *, bits=6, luma=False):
        images = np.asarray(images)
        for moving, fixed in pairwise(by_brightness(images)):
            yield from search(
                gray(images[fixed], luma=luma), gray(images[moving], luma=luma), bits=bits
            )

    pair_offsets = [
        state.offset for state in align_steps(images, bits=bits, luma=luma) if state.level == 0
    ]
    return chain_offsets(by_brightness(np.asarray(images)), pair_offsets)


@mistake(
    "align_to_the_first",
    says="You align the images to the first one. Align them to the image of middle brightness.",
)
def to_the_first(images, *, bits=6, luma=False):
    def chain_offsets(order, steps):
        sums = np.cumsum(np.reshape(steps, (-1, 2))[::-1], axis=0)[::-1]  # onto the brightest
        offsets = np.zeros((len(order), 2), np.int64)
        offsets[order[:-1]] = sums
        return offsets - offsets[0]

    pair_offsets = [
        state.offset for state in align_steps(images, bits=bits, luma=luma) if state.level == 0
    ]
    return chain_offsets(by_brightness(np.asarray(images)), pair_offsets)


@mistake(
    "align_wrong_way",
    says="Your offsets say how far each image has moved. Return how far it must move to match "
    "the middle one: change the sign.",
)
def wrong_way(images, *, bits=6, luma=False):
    pair_offsets = [
        state.offset for state in align_steps(images, bits=bits, luma=luma) if state.level == 0
    ]
    return -chain_offsets(by_brightness(np.asarray(images)), pair_offsets)
