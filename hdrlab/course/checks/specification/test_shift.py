"""Moving photographs: shift(images, offsets) -> the images moved, and cut to what all of them show."""

import numpy as np

from hdrlab.course.checks.compare import points, same


def agree(subject, rng, offsets, *, channels=(), what="the moved images"):
    """Compare the part that all show of views of one picture, which `offsets` (dy, dx) lay on each other."""
    margin, H, W = 12, 40, 50
    world = rng.integers(0, 256, (H + 2 * margin, W + 2 * margin, *channels), dtype=np.uint8)
    images = [
        world[margin + dy : margin + dy + H, margin + dx : margin + dx + W] for dy, dx in offsets
    ]
    (top, left), (bottom, right) = (
        np.maximum(offsets, 0).max(0),
        np.minimum(offsets, 0).min(0) + (H, W),
    )
    common = world[margin + top : margin + bottom, margin + left : margin + right]
    same(subject.shift(np.stack(images), offsets), np.stack([common] * len(offsets)), 0, what=what)


@points(5)
def test_moved_images_lie_on_each_other(subject, rng):
    """An offset (dy, dx) says where the image must move: down, and to the right.

    After the move, what stood at (y, x) stands at (y + dy, x + dx).

    The part that all show begins at the largest offset, and in image j at that less its own.
    """
    agree(subject, rng, np.array([[0, 0], [3, -5]]))


@points(5)
def test_nothing_comes_in_from_the_other_side(subject, rng):
    """Where do the pixels at the border come from?

    np.roll brings in at the left what left at the right.

    Cut the images to the rectangle that every moved one covers.
    """
    agree(subject, rng, rng.integers(-9, 10, (4, 2)))


@points(3)
def test_colour_moves_like_gray(subject, rng):
    """Three channels move together.

    Only the first two axes of an image are places.

    image[top:bottom, left:right] takes all channels along.
    """
    agree(subject, rng, rng.integers(-6, 7, (3, 2)), channels=(3,))


def test_images_that_need_not_move_stay_whole(subject, rng):
    """What is to be done where all offsets are the same?

    All images move, and all show the same part of the picture then.

    Only differences between offsets cost pixels, beside what leaves the frame of (0, 0).
    """
    agree(subject, rng, np.zeros((3, 2), int), what="the images")
