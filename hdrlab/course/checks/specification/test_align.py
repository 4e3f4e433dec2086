"""Ward's alignment: align(images, bits=6) -> offsets (P, 2), 0 for the image of middling brightness."""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.course.checks.compare import finite, points, same

MARGIN, H, W = 48, 160, 208
# the coarsest level has 10 x 13 pixels: one of 5 x 6 is a matter of ties, which any scan may break
BITS = 5


def scene(rng, *, fine=0.05):
    """Return a scene (H + 2 MARGIN, W + 2 MARGIN) of median 1: soft blobs, hard edges, fine texture."""
    shape = (H + 2 * MARGIN, W + 2 * MARGIN)
    soft = sum(s * gaussian_filter(rng.standard_normal(shape), s) for s in (3, 8, 20))
    hard = np.zeros(shape)
    for _ in range(40):
        y, x, size = rng.integers(0, shape[0]), rng.integers(0, shape[1]), rng.integers(6, 40)
        hard[y : y + size, x : x + size] += rng.normal()
    lE = 0.8 * soft + 0.5 * hard + fine * rng.standard_normal(shape)
    return np.exp(lE - np.median(lE))


def photographs(rng, E, offsets, times, noise=0.004):
    """Return the 8-bit photographs (P, H, W) that `offsets` lay on each other."""
    taken = []
    for (dy, dx), t in zip(offsets, times, strict=True):
        X = 0.2 * t * E[MARGIN + dy : MARGIN + dy + H, MARGIN + dx : MARGIN + dx + W]
        X = X + noise * np.sqrt(X + 0.01) * rng.standard_normal(X.shape)
        taken.append((np.clip(X, 0, 1) ** (1 / 2.2) * 255 + 0.5).astype(np.uint8))
    return np.stack(taken)


def drawn(rng, least, most):
    """Return an offset (dy, dx), each as far as that in either direction."""
    return tuple((rng.choice([-1, 1], 2) * rng.integers(least, most + 1, 2)).tolist())


@points(1, needs="test_photographs_a_pixel_apart_are_told_apart")
def test_identical_photographs_stay_where_they_are(subject, rng):
    """What is there to be moved?

    The offsets are an array (P, 2), a row for each image.

    The same image twice: zeros.
    """
    images = photographs(rng, scene(rng), [(0, 0)], [1])
    same(subject.align(np.repeat(images, 3, axis=0)), np.zeros((3, 2)), 0, what="the offsets")


def test_photographs_a_pixel_apart_are_told_apart(subject, rng):
    """Is anything found at all, whatever its sign?

    At the finest level an offset is at most a pixel either way.

    Of the nine candidates, the one with the fewest differing pixels is the offset.
    """
    images = photographs(rng, scene(rng), [(0, 0), drawn(rng, 1, 1)], (1, 1))
    came = finite(subject.align(images), (2, 2), what="the offsets").astype(float)
    same(np.abs(came[1] - came[0]), [1, 1], 0, what="the offset's size in y and in x")


@points(6)
def test_a_known_offset_is_found_two_stops_apart(subject, rng):
    """Look at the sign first: the offset says where the image must move, not where it has moved to.

    At every level the best of nine is found, and twice that is where the next level begins.

    XOR of the bitmaps, AND with both exclusion bitmaps; the least share of the compared pixels
    wins.
    """
    for least, times in zip(
        (16, 16, 5, 5, 5, 5), 3 * ((1, 4), (4, 1)), strict=True
    ):  # 16: on all levels
        dy, dx = drawn(rng, least, 20)
        images = photographs(rng, scene(rng), [(0, 0), (dy, dx)], times)
        came = finite(subject.align(images, bits=BITS), (2, 2), what="the offsets")
        same(came[1] - came[0], [dy, dx], 0, what="the offset of the second image from the first")


@points(4, needs="test_photographs_a_pixel_apart_are_told_apart")
def test_in_a_tie_nothing_moves(subject, rng):
    """Which candidate wins where all nine are equally good?

    A scan that begins in the corner, and takes the first of equals, walks off diagonally, a pixel a
    level.

    Begin with the centre, and move only for a count that is less.
    """
    flat = np.full((2, 96, 128), int(rng.integers(60, 200)), np.uint8)
    same(subject.align(flat), np.zeros((2, 2)), 0, what="the offsets of two even walls")
    for _ in range(3):
        levels = gaussian_filter(rng.standard_normal(160), 2)
        bars = np.tile(128 + 120 * levels / np.abs(levels).max(), (120, 1))
        images = np.stack([bars, rng.uniform(0.6, 0.8) * bars]).astype(np.uint8)
        same(
            subject.align(images),
            np.zeros((2, 2)),
            0,
            what="the offsets of upright bars that agree",
        )


@points(5)
def test_fine_texture_does_not_mislead_the_coarse_levels(subject, rng):
    """At which level is the picture compared with its median?

    A bitmap made small is not the bitmap of the small picture: fine texture becomes noise.

    Shrink the gray picture, and make threshold and bitmaps anew at every level.
    """
    for _ in range(2):
        dy, dx = drawn(rng, 17, 23)
        images = photographs(rng, scene(rng, fine=1.6), [(0, 0), (dy, dx)], (1, 1.5))
        came = finite(subject.align(images, bits=BITS), (2, 2), what="the offsets")
        same(came[1] - came[0], [dy, dx], 0, what="the offset of the second image from the first")


@points(2)
def test_noise_that_stays_on_the_sensor_does_not_count(subject, rng):
    """More than half of the picture is a wall as bright as the median. What does its bitmap show?

    Noise alone; and where a sensor's noise is the same in each photograph, it says that nothing has
    moved.

    AND the differences with both exclusion bitmaps before you count.
    """
    dy, dx = drawn(rng, 3, 12)
    images = photographs(rng, scene(rng), [(0, 0), (dy, dx)], (1, 1))
    images[:, :, :128] = np.median(images[:, :, 128:]) + rng.integers(-2, 3, (H, 128))
    came = finite(subject.align(images, bits=BITS), (2, 2), what="the offsets")
    same(came[1] - came[0], [dy, dx], 0, what="the offset of the second image from the first")


@points(4)
def test_the_range_is_two_to_the_bits_minus_one(subject, rng):
    """How far can an offset of n levels reach? 1 + 2 + 4 + ...

    Each level doubles what the level above found, and adds at most 1.

    Check that the coarsest level is used too, and that you double before you look around.
    """
    E, (dy, dx) = scene(rng), (int(rng.choice([-15, 15])), int(rng.choice([-15, 15])))
    came = finite(subject.align(photographs(rng, E, [(dy, dx), (0, 0)], (1, 2)), bits=4), (2, 2))
    same(came[0] - came[1], [dy, dx], 0, what="the offset at 4 bits")
    came = finite(subject.align(photographs(rng, E, [(1, -1), (0, 0)], (1, 2)), bits=1), (2, 2))
    same(came[0] - came[1], [1, -1], 0, what="the offset at 1 bit")


@points(6)
def test_a_bracket_is_aligned_along_its_neighbours_to_the_one_in_the_middle(subject, rng):
    """Neighbours in brightness have bitmaps that are alike; the darkest and the brightest have not.

    The offsets of pairs are summed along the chain, away from the image in the middle.

    Sort by brightness to make the pairs, and give the offsets back in the order that the images
    came in.
    """
    true = np.cumsum(rng.choice([-1, 1], 2) * rng.integers(3, 8, (5, 2)), axis=0)
    true -= true[2]
    images = photographs(rng, scene(rng), true, 2.0 ** np.arange(-2, 3))
    order = np.insert(
        rng.permutation([0, 1, 3, 4]), rng.integers(1, 5), 2
    )  # the middle is not first
    same(subject.align(images[order], bits=BITS), true[order], 1, what="the offsets")
