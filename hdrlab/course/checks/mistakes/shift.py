"""Known mistakes in `shift`, the task of hdrlab.align.shift.shift."""

import numpy as np

from hdrlab.align.shift import as_offsets, crop
from hdrlab.course.checks.mistakes import Question, mistake


@mistake(
    "shift_axes_swapped",
    says="You took dx for dy: an offset is (dy, dx), rows first, like the axes of the array.",
    questions=(
        Question(
            code="images = np.arange(9).reshape(1, 3, 3)\nshift(images, [[1, 1]])[0][0][0]",
            why="The pixel 0 of the corner moves one row down and one column to the right. "
            "It is the first pixel that is left.",
            because="An offset $(dy, dx)$",
        ),
        Question(
            code="images = np.arange(9).reshape(1, 3, 3)\nnp.shape(shift(images, [[1, 0]]))[1]",
            why="The image moves 1 row down, so it loses 1 of its 3 rows.",
            because="An offset $(dy, dx)$",
        ),
        Question(
            code="images = np.arange(9).reshape(1, 3, 3)\nshift(images, [[1, 0]])[0][-1][-1]",
            why="dy = 1 comes first and means rows. The row 3, 4, 5 moves into the last row.",
            because="An offset $(dy, dx)$",
        ),
    ),
    fixes=(
        ("[0]", "[1]"),
        ("[1]", "[0]"),
    ),
)
def axes_swapped(images, offsets):
    images = np.asarray(images)
    moved = as_offsets(offsets, len(images))
    moved = moved[:, ::-1]
    if not moved.any():
        return images
    rows, columns = crop(moved, images.shape[1:3])
    return np.stack(
        [
            image[rows.start - dy : rows.stop - dy, columns.start - dx : columns.stop - dx]
            for image, (dy, dx) in zip(images, moved.tolist(), strict=True)
        ]
    )


@mistake(
    "shift_rolls_around",
    says="np.roll moves pixels from one border to the opposite one: crop the images to what all "
    "of them show.",
    questions=(
        Question(
            code="images = np.array([[[1, 2], [3, 4]]])\nshift(images, [[0, 0]])[0][0][0]",
            why="Nothing moves.",
            because="An offset $(dy, dx)$",
        ),
        Question(
            code="images = np.array([[[1, 2], [3, 4]]])\nnp.shape(shift(images, [[1, 0]]))[1]",
            why="The image moves 1 row down. It has no pixels for the first row, so 1 row is left.",
            because="Move the images",
        ),
        Question(
            code="images = np.array([[[1, 2], [3, 4]]])\nshift(images, [[1, 0]])[0][0][0]",
            why="The row 1, 2 moves down. The row 3, 4 leaves the frame and does not come "
            "back at the top.",
            because="Move the images",
        ),
    ),
)
def rolls_around(images, offsets):
    images = np.asarray(images)
    moved = as_offsets(offsets, len(images))
    if not moved.any():
        return images
    rows, columns = crop(moved, images.shape[1:3])
    return np.stack(
        [
            np.roll(image, (dy, dx), axis=(0, 1))
            for image, (dy, dx) in zip(images, moved.tolist(), strict=True)
        ]
    )


@mistake(
    "shift_wrong_way",
    says="Your images move the wrong way: (dy, dx) is where an image must go, down and to the "
    "right.",
    questions=(
        Question(
            code="images = np.array([[[1, 2, 3]]])\nshift(images, [[0, 0]])[0][0][0]",
            why="Nothing moves.",
            because="An offset $(dy, dx)$",
        ),
        Question(
            code="images = np.array([[[1, 2, 3]]])\nshift(images, [[0, 1]])[0][0][0]",
            why="dx = 1 moves every pixel to the right. The pixel 1 is now the first one "
            "that the frame shows.",
            because="An offset $(dy, dx)$",
        ),
        Question(
            code="images = np.array([[[1], [2], [3]]])\nshift(images, [[1, 0]])[0][0][0]",
            why="dy = 1 moves every pixel down. The pixel 1 is now the first one that the "
            "frame shows.",
            because="An offset $(dy, dx)$",
        ),
    ),
)
def wrong_way(images, offsets):
    images = np.asarray(images)
    moved = as_offsets(offsets, len(images))
    moved = -moved
    if not moved.any():
        return images
    rows, columns = crop(moved, images.shape[1:3])
    return np.stack(
        [
            image[rows.start - dy : rows.stop - dy, columns.start - dx : columns.stop - dx]
            for image, (dy, dx) in zip(images, moved.tolist(), strict=True)
        ]
    )


@mistake(
    "shift_without_the_frame",
    says="You crop to what the moved images share, even outside of the original frame. Crop as if "
    "one more image had the offset (0, 0).",
)
def without_the_frame(images, offsets):
    images = np.asarray(images)
    moved = as_offsets(offsets, len(images))
    height, width = images.shape[1:3]
    top, left = moved.max(axis=0)
    bottom, right = moved.min(axis=0) + (height, width)
    return np.stack(
        [
            image[top - dy : bottom - dy, left - dx : right - dx]
            for image, (dy, dx) in zip(images, moved.tolist(), strict=True)
        ]
    )
