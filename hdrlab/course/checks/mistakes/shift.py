"""Known mistakes in `shift`, the task of hdrlab.align.shift.shift."""

import numpy as np

from hdrlab.align.shift import as_offsets, crop
from hdrlab.course.checks.mistakes import mistake


@mistake(
    "shift_axes_swapped",
    says="You took dx for dy: an offset is (dy, dx), rows first, like the axes of the array.",
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
