"""Checks of shift(images, offsets): the moved images, cropped to the area that all of them show."""

import numpy as np

from hdrlab.course.checks.compare import points, same


def agree(subject, rng, offsets, *, channels=(), what="the moved images"):
    """Compare the common part of views of one scene that `offsets` (dy, dx) align."""
    margin = 12
    H = 40
    W = 50
    world = rng.integers(0, 256, (H + 2 * margin, W + 2 * margin, *channels), dtype=np.uint8)
    images = [
        world[margin + dy : margin + dy + H, margin + dx : margin + dx + W] for dy, dx in offsets
    ]
    top, left = np.maximum(offsets, 0).max(0)
    bottom, right = np.minimum(offsets, 0).min(0) + (H, W)
    common = world[margin + top : margin + bottom, margin + left : margin + right]
    same(subject.shift(np.stack(images), offsets), np.stack([common] * len(offsets)), 0, what=what)


def with_a_still(offsets):
    """Return the offsets of these images, and of one that does not move."""
    return np.vstack([[[0, 0]], offsets])


@points(5)
def test_moved_images_are_aligned(subject, rng):
    """An offset (dy, dx) says where the image must move: down, and to the right.

    After the move, the pixel from (y, x) is at (y + dy, x + dx).

    The common area starts at the largest offset; in image j, subtract the offset of image j.
    """
    agree(subject, rng, np.array([[0, 0], [3, -5]]))


@points(5)
def test_pixels_do_not_wrap_around_the_border(subject, rng):
    """Where do the pixels at your borders come from?

    np.roll moves pixels from the right border to the left one.

    Crop the images to the rectangle that all moved images cover.
    """
    agree(subject, rng, with_a_still(rng.integers(-9, 10, (3, 2))))


@points(3)
def test_color_images_move_like_gray_ones(subject, rng):
    """Move all three channels together.

    Only the first two axes of an image are positions.

    image[top:bottom, left:right] keeps all channels.
    """
    agree(subject, rng, with_a_still(rng.integers(-6, 7, (2, 2))), channels=(3,))


def test_images_without_offsets_stay_whole(subject, rng):
    """All offsets are 0 here. What should your function do?

    Return the images as they are.

    Crop only what an offset moves out of the frame, or leaves uncovered.
    """
    agree(subject, rng, np.zeros((3, 2), int), what="the images")


@points(2)
def test_images_that_all_move_the_same_way_keep_to_the_frame(subject, rng):
    """All images move down and to the right. Which rows does the result begin with?

    Not with the first rows that all images cover after the move, if these are outside of the frame.

    Crop as if one more image had the offset (0, 0).
    """
    offsets = rng.integers(2, 9, (3, 2)) * rng.choice([-1, 1], 2)
    agree(subject, rng, offsets, what="images that all move the same way")
