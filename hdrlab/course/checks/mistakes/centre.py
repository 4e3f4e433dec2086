"""Known mistakes in `centre`, the task of hdrlab.capture.metering.centre."""

import numpy as np

from hdrlab.capture.metering import spot
from hdrlab.course.checks.mistakes import mistake


def _places(shape, at):
    """Return how far down and right of `at` each pixel lies, in heights and in widths of the picture."""
    down, right = ((np.arange(n) + 0.5) / n - part for n, part in zip(shape, at, strict=True))
    return down[:, None], right[None, :]


def _normal(w):
    return w / w.sum()


@mistake(
    "centre_distance_in_pixels",
    says="You measure the distance in pixels. Measure it in image heights down and image "
    "widths to the right, so that it fits the image.",
)
def distance_in_pixels(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    down, right = _places(shape, at)
    squared = (down * shape[0]) ** 2 + (right * shape[1]) ** 2
    core = spot(shape, at=at, share=share) > 0
    low = 0.01
    high = 100.0
    for _ in range(60):
        sigma = np.sqrt(low * high)
        w = _normal(np.exp(-squared / (2 * sigma**2)))
        low, high = (sigma, high) if w[core].sum() > inside else (low, sigma)
    return w


@mistake(
    "centre_disc_is_an_ellipse",
    says="You select the pixels of the spot by relative distance, which gives an ellipse. Measure"
    " the spot in pixels.",
)
def disc_is_an_ellipse(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    down, right = _places(shape, at)
    squared = down**2 + right**2
    core = squared <= np.sort(squared, axis=None)[round(share * squared.size) - 1]
    low = 0.01
    high = 100.0
    for _ in range(60):
        sigma = np.sqrt(low * high)
        w = _normal(np.exp(-squared / (2 * sigma**2)))
        low, high = (sigma, high) if w[core].sum() > inside else (low, sigma)
    return w


@mistake(
    "centre_not_normalised",
    says="Your weights do not sum to 1. Divide them by their sum; otherwise the reading "
    "depends on the number of pixels.",
)
def not_normalised(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    down, right = _places(shape, at)
    squared = down**2 + right**2
    core = spot(shape, at=at, share=share) > 0
    low = 0.01
    high = 100.0
    for _ in range(60):
        sigma = np.sqrt(low * high)
        w = _normal(np.exp(-squared / (2 * sigma**2)))
        low, high = (sigma, high) if w[core].sum() > inside else (low, sigma)
    return w * w.size


@mistake(
    "centre_exponential",
    says="Your weight has a peak in the middle, exp(-d / sigma). A Gaussian falls as exp(-d^2 "
    "/ (2 sigma^2)).",
)
def exponential(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    down, right = _places(shape, at)
    squared = down**2 + right**2
    core = spot(shape, at=at, share=share) > 0
    low = 0.01
    high = 100.0
    for _ in range(60):
        sigma = np.sqrt(low * high)
        w = _normal(np.exp(-np.sqrt(squared) / sigma))
        low, high = (sigma, high) if w[core].sum() > inside else (low, sigma)
    return w
