"""Checks of align(images, bits=6), Ward's alignment: offsets (P, 2), (0, 0) for the image of
middle brightness.
"""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.course.checks.compare import finite, points, same

MARGIN = 48
H = 160
W = 208
# the coarsest level has 10 x 13 pixels: at 5 x 6 ties would decide, and any order may break them
BITS = 5


def scene(rng, *, fine=0.05):
    """Return a scene (H + 2 MARGIN, W + 2 MARGIN) of median 1 with soft blobs, hard edges and
    fine texture.
    """
    shape = (H + 2 * MARGIN, W + 2 * MARGIN)
    soft = sum(s * gaussian_filter(rng.standard_normal(shape), s) for s in (3, 8, 20))
    hard = np.zeros(shape)
    for _ in range(40):
        y = rng.integers(0, shape[0])
        x = rng.integers(0, shape[1])
        size = rng.integers(6, 40)
        hard[y : y + size, x : x + size] += rng.normal()
    lE = 0.8 * soft + 0.5 * hard + fine * rng.standard_normal(shape)
    return np.exp(lE - np.median(lE))


def photographs(rng, E, offsets, times, noise=0.004):
    """Return 8-bit photos (P, H, W) that `offsets` align."""
    photos = []
    for (dy, dx), t in zip(offsets, times, strict=True):
        X = 0.2 * t * E[MARGIN + dy : MARGIN + dy + H, MARGIN + dx : MARGIN + dx + W]
        X = X + noise * np.sqrt(X + 0.01) * rng.standard_normal(X.shape)
        photos.append((np.clip(X, 0, 1) ** (1 / 2.2) * 255 + 0.5).astype(np.uint8))
    return np.stack(photos)


def draw_inputs(rng, min_shift, max_shift):
    """Return an offset (dy, dx), each of `least` to `most` pixels in a random direction."""
    return tuple((rng.choice([-1, 1], 2) * rng.integers(min_shift, max_shift + 1, 2)).tolist())


def get_answer(subject, images, **options):
    """Return the offsets (P, 2) of a subject: (dy, dx), where each image must move."""
    answer = finite(subject.align(images, **options), (len(images), 2), what="the offsets")
    answer = answer.astype(float)
    return answer


# on a few pixels many offsets are equally good, and right functions find different ones
check_one_input = None


@points(1, needs="test_a_shift_of_one_pixel_is_found")
def test_identical_images_have_offsets_of_zero(subject, rng):
    """Nothing has to move here.

    Return an array (P, 2) with one row for each image.

    For copies of one image, all offsets are 0.
    """
    images = photographs(rng, scene(rng), [(0, 0)], [1])
    same(get_answer(subject, np.repeat(images, 3, axis=0)), np.zeros((3, 2)), 0, what="the offsets")


def test_a_shift_of_one_pixel_is_found(subject, rng):
    """This check ignores the sign. Does your function find any shift at all?

    At the finest level, an offset changes by at most one pixel in each direction.

    Try the nine candidates, and take the one with the fewest differing pixels.
    """
    images = photographs(rng, scene(rng), [(0, 0), draw_inputs(rng, 1, 1)], (1, 1))
    answer = get_answer(subject, images)
    same(np.abs(answer[1] - answer[0]), [1, 1], 0, what="the size of the offset in y and in x")


@points(6)
def test_a_known_offset_is_found_two_stops_apart(subject, rng):
    """Check the sign first. The offset says where the image must move, not where it has moved to.

    At each level, take the best of the nine candidates. Twice this offset is the start of the next
    finer level.

    XOR the bitmaps, and AND the result with both exclusion bitmaps. The candidate with the smallest
    fraction of differing pixels wins.
    """
    # 16: on all levels
    for min_shift, times in zip((16, 16, 5, 5, 5, 5), 3 * ((1, 4), (4, 1)), strict=True):
        dy, dx = draw_inputs(rng, min_shift, 20)
        images = photographs(rng, scene(rng), [(0, 0), (dy, dx)], times)
        answer = get_answer(subject, images, bits=BITS)
        same(
            answer[1] - answer[0], [dy, dx], 0, what="the offset of the second image from the first"
        )


@points(4, needs="test_a_shift_of_one_pixel_is_found")
def test_in_a_tie_nothing_moves(subject, rng):
    """Which candidate do you take when all nine are equally good?

    If you start in a corner and take the first of equal candidates, the offset drifts diagonally by
    one pixel per level.

    Start with the center, and move only if another candidate has a smaller count.
    """
    flat = np.full((2, 96, 128), int(rng.integers(60, 200)), np.uint8)
    same(get_answer(subject, flat), np.zeros((2, 2)), 0, what="the offsets of two uniform images")
    for _ in range(3):
        levels = gaussian_filter(rng.standard_normal(160), 2)
        bars = np.tile(128 + 120 * levels / np.abs(levels).max(), (120, 1))
        images = np.stack([bars, rng.uniform(0.6, 0.8) * bars]).astype(np.uint8)
        same(
            get_answer(subject, images),
            np.zeros((2, 2)),
            0,
            what="the offsets of two images of vertical bars",
        )


@points(5)
def test_fine_texture_does_not_mislead_the_coarse_levels(subject, rng):
    """At which level do you compare the image with its median?

    A shrunk bitmap is not the bitmap of the shrunk image: fine texture becomes noise.

    Shrink the gray image. Compute the threshold and both bitmaps again at each level.
    """
    for _ in range(2):
        dy, dx = draw_inputs(rng, 17, 23)
        images = photographs(rng, scene(rng, fine=1.6), [(0, 0), (dy, dx)], (1, 1.5))
        answer = get_answer(subject, images, bits=BITS)
        same(
            answer[1] - answer[0], [dy, dx], 0, what="the offset of the second image from the first"
        )


@points(2)
def test_noise_near_the_median_does_not_count(subject, rng):
    """More than half of this image is a wall that is as bright as the median. What does its bitmap
    show?

    It shows only noise. This noise is the same in both images, so it suggests that nothing has
    moved.

    AND the differences with both exclusion bitmaps before you count.
    """
    dy, dx = draw_inputs(rng, 3, 12)
    images = photographs(rng, scene(rng), [(0, 0), (dy, dx)], (1, 1))
    images[:, :, :128] = np.median(images[:, :, 128:]) + rng.integers(-2, 3, (H, 128))
    answer = get_answer(subject, images, bits=BITS)
    same(answer[1] - answer[0], [dy, dx], 0, what="the offset of the second image from the first")


@points(4)
def test_the_range_is_two_to_the_bits_minus_one(subject, rng):
    """How far can an offset of n levels reach? 1 + 2 + 4 + ...

    Each level doubles the offset of the coarser level and adds at most 1.

    Make sure that you use the coarsest level, and that you double the offset before you search
    around it.
    """
    E = scene(rng)
    dy = int(rng.choice([-15, 15]))
    dx = int(rng.choice([-15, 15]))
    answer = get_answer(subject, photographs(rng, E, [(dy, dx), (0, 0)], (1, 2)), bits=4)
    same(answer[0] - answer[1], [dy, dx], 0, what="the offset at 4 bits")
    answer = get_answer(subject, photographs(rng, E, [(1, -1), (0, 0)], (1, 2)), bits=1)
    same(answer[0] - answer[1], [1, -1], 0, what="the offset at 1 bit")


@points(6)
def test_a_bracket_is_aligned_in_pairs_to_its_middle_image(subject, rng):
    """Align neighbors in brightness: their bitmaps look alike. The bitmaps of the darkest and the
    brightest image do not.

    Sum the offsets of the pairs along the chain, starting from the image in the middle.

    Sort by brightness to form the pairs, but return the offsets in the order of the input images.
    """
    true_offsets = np.cumsum(rng.choice([-1, 1], 2) * rng.integers(3, 8, (5, 2)), axis=0)
    true_offsets -= true_offsets[2]
    images = photographs(rng, scene(rng), true_offsets, 2.0 ** np.arange(-2, 3))
    # the image of middle brightness is neither the first of the list nor in its middle
    order = np.insert(rng.permutation([0, 1, 3, 4]), rng.choice([1, 3, 4]), 2)
    same(get_answer(subject, images[order], bits=BITS), true_offsets[order], 1, what="the offsets")
