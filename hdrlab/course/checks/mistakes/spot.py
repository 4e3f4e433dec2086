"""Known mistakes in `spot`, the task of hdrlab.capture.metering.spot."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


def _places(shape, at):
    """Return how far down and right of `at` each pixel lies, in heights and in widths of the picture."""
    down, right = ((np.arange(n) + 0.5) / n - part for n, part in zip(shape, at, strict=True))
    return down[:, None], right[None, :]


def _normal(w):
    return w / w.sum()


@mistake(
    "spot_not_normalised",
    says="Your weights do not sum to 1. Divide them by their sum; otherwise the reading "
    "depends on the number of pixels in the spot.",
)
def not_normalised(shape, *, at=(0.5, 0.5), share=0.03):
    def _normal(w):
        return w

    down, right = _places(shape, at)
    distance = np.hypot(down * shape[0], right * shape[1])
    reach = np.sort(distance, axis=None)[max(round(share * distance.size), 1) - 1]
    return _normal(distance <= reach)


@mistake(
    "spot_ellipse",
    says="You measure the distance relative to the image size, so your disc is an ellipse. "
    "Measure it in pixels.",
)
def ellipse(shape, *, at=(0.5, 0.5), share=0.03):
    down, right = _places(shape, at)
    distance = np.hypot(down, right)
    reach = np.sort(distance, axis=None)[max(round(share * distance.size), 1) - 1]
    return _normal(distance <= reach)


@mistake(
    "spot_axes_swapped",
    says="You took `at` as (across, down). It is (down, across), like the axes of the array.",
)
def axes_swapped(shape, *, at=(0.5, 0.5), share=0.03):
    def _places(shape, at):
        down, right = (
            (np.arange(n) + 0.5) / n - part for n, part in zip(shape, at[::-1], strict=True)
        )
        return down[:, None], right[None, :]

    down, right = _places(shape, at)
    distance = np.hypot(down * shape[0], right * shape[1])
    reach = np.sort(distance, axis=None)[max(round(share * distance.size), 1) - 1]
    return _normal(distance <= reach)
