"""The inputs of a version, made from those of the checks, and what a page shows of its answer.

photograph  gray levels of a photograph or an embedded scene, (H, W) uint8
levels      what a page draws of an answer: uint8, (n,) for a curve, (H, W) or (H, W, 3) for an image
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from hdrlab.course.checks.compare import as_listed
from hdrlab.course.checks.misconceptions import difference
from hdrlab.io import web
from hdrlab.show.plots.differences import drawn

# longer side of a photograph as functions get it, approximately
PHOTOGRAPH_SIDE_PIXELS = 96
# entries of a curve, and pixels of an image's side, that are worth drawing
MIN_DRAWN_SIZE = 8
# parts of a curve, and of each side of an image, that are compared
PARTS_PER_SIDE = 8
# mean difference of two images that a person sees
VISIBLE_LEVELS = 4.5
# the same in one part
VISIBLE_LEVELS_IN_PART = VISIBLE_LEVELS / 3
# how many times as much a version changes in its own part as in another version's
CLEAR_PART_RATIO = 1.25
# relative difference of two numbers that a person tells apart
READABLE_DIFFERENCE = 0.02
# fraction of finite numbers in an answer that can be drawn
MIN_FINITE_FRACTION = 0.9
# empty space above and below a curve, as a fraction of its range
CURVE_MARGIN_FRACTION = 0.25
# points of a curve in a figure
MAX_CURVE_POINTS = 256


def map_arrays(change: Callable[[np.ndarray], Any], value: Any) -> Any:
    """Return a value with `change` applied to each array and number; texts and flags stay."""
    if isinstance(value, tuple):
        return tuple(map_arrays(change, item) for item in value)
    if isinstance(value, list):
        return [map_arrays(change, item) for item in value]
    if isinstance(value, dict):
        return {name: map_arrays(change, item) for name, item in value.items()}
    if value is None or isinstance(value, bool | str | bytes):
        return value
    return change(np.asarray(value))


def arrays_in(value: Any) -> list[np.ndarray]:
    """Return the arrays and numbers of a value."""
    arrays: list[np.ndarray] = []
    map_arrays(arrays.append, value)
    return arrays


def count(value: Any) -> int:
    """Return how many numbers a value holds."""
    return sum(array.size for array in arrays_in(value))


def is_readable(answer: Any, max_numbers: int) -> bool:
    """Return whether an answer is a few finite numbers."""
    for array in arrays_in(answer):
        if array.dtype.kind not in "biuf" or not np.isfinite(array).all():
            return False
    return 0 < count(answer) <= max_numbers


def round_digits(array: np.ndarray, digits: int) -> np.ndarray:
    """Return a float array rounded to significant digits, in float64; other arrays stay."""
    if array.dtype.kind != "f":
        return array
    rounded = np.vectorize(lambda number: float(f"{number:.{digits}g}"), otypes=[float])
    return rounded(array)


def format_answer(value: Any) -> str:
    """Return an answer as Python writes it, with three significant digits.

    Examples
    --------
    >>> format_answer((np.array([0.12345, 2]), True, None))
    '([0.123, 2.0], True, None)'
    """
    return repr(map_arrays(lambda array: round_digits(array, 3).tolist(), value))


def format_argument(value: Any, max_numbers: int) -> str:
    """Return an argument as Python writes it, or the size and range of one with too many numbers.

    Examples
    --------
    >>> format_argument(np.linspace(0, 1, 128).reshape(8, 16), 16)
    '‹8 × 16 numbers from 0 to 1›'
    """
    if count(value) <= max_numbers:
        return format_answer(value)
    texts = []
    for array in arrays_in(value):
        size = " × ".join(map(str, array.shape))
        texts.append(f"‹{size} numbers from {array.min():.3g} to {array.max():.3g}›")
    return ", ".join(texts)


def format_call(
    task: str, names: Sequence[str], args: Any, kwargs: Mapping[str, Any], max_numbers: int
) -> str:
    """Return a call as Python writes it, with the names of its positional arguments, too."""
    arguments = [*zip(names, args, strict=False), *kwargs.items()]
    texts = [f"{name}={format_argument(value, max_numbers)}" for name, value in arguments]
    return f"{task}({', '.join(texts)})"


def apart(a: Any, b: Any) -> bool:
    """Return whether a person tells two answers in numbers apart."""
    return max(difference(a, b), difference(b, a)) > READABLE_DIFFERENCE


def small(value: Any, side: int = 2) -> Any:
    """Return a value small enough to compute with by hand: the middle of arrays, in two digits.

    Examples
    --------
    >>> small((np.linspace(0, 1, 9), 0.777))
    (array([0.38, 0.5 ]), 0.78)
    """

    def crop(array: np.ndarray) -> Any:
        middle = [
            slice((n - side) // 2, (n + side) // 2) if n > side + 1 else slice(n)
            for n in array.shape
        ]
        part = round_digits(array[tuple(middle)], 2).astype(array.dtype)
        return part if part.ndim else part.item()

    return map_arrays(crop, value)


def put_photograph(value: Any, photograph: np.ndarray) -> Any:
    """Return a value whose images show the photograph, each with the pixel values that it had."""
    return map_arrays(lambda image: _with_photograph(image, photograph), value)


def _with_photograph(image: np.ndarray, photograph: np.ndarray) -> np.ndarray:
    """Return an image that shows the photograph; a small array or one of other form stays."""
    has_channels = image.ndim > 2 and image.shape[-1] == 3
    axes = (-3, -2) if has_channels else (-2, -1)
    if image.ndim < 2 or min(image.shape[axis] for axis in axes) < MIN_DRAWN_SIZE:
        return image
    planes = np.moveaxis(image, axes, (-2, -1))
    repeats = max(1, PHOTOGRAPH_SIDE_PIXELS // max(planes.shape[-2:]))
    h = repeats * planes.shape[-2]
    w = repeats * planes.shape[-1]
    rows = np.arange(h) * photograph.shape[0] // h
    columns = np.arange(w) * photograph.shape[1] // w
    resized = photograph[np.ix_(rows, columns)]
    # the k-th brightest pixel of the photograph gets the k-th largest value of the image
    rank = np.argsort(np.argsort(resized, axis=None, kind="stable")) // repeats**2
    values = np.sort(planes.reshape(*planes.shape[:-2], -1))[..., rank]
    shown = values.reshape(*planes.shape[:-2], h, w)
    return np.ascontiguousarray(np.moveaxis(shown, (-2, -1), axes))


def drawable_part(answer: Any) -> np.ndarray | None:
    """Return the image or curve in an answer, or None if it has none.

    Of several states, take the last one. Of several arrays, take the largest.
    """
    if isinstance(answer, list):
        answer = as_listed(answer)
    while isinstance(answer, list) and answer:
        answer = as_listed(answer[-1]) if isinstance(answer[-1], list) else answer[-1]
    values = answer if isinstance(answer, tuple) else (answer,)
    arrays = [value for value in values if isinstance(value, np.ndarray)]
    largest: np.ndarray = max(arrays, key=np.size, default=np.zeros(0))
    while largest.ndim > 3 or (largest.ndim == 3 and largest.shape[-1] != 3):
        largest = largest[0]
    if largest.ndim == 2 and 0 < largest.shape[1] <= 3:  # curves of the channels
        largest = largest[:, 0]
    if largest.ndim == 0 or min(largest.shape[:2]) < MIN_DRAWN_SIZE:
        return None
    if np.isfinite(largest).mean() <= MIN_FINITE_FRACTION:
        return None
    return largest.astype(np.float64)


def scale(own: np.ndarray) -> tuple[float, float]:
    """Return the numbers drawn as black and white, or at the bottom and top of a curve's frame."""
    low = np.nanmin(own)
    high = np.nanmax(own)
    margin = CURVE_MARGIN_FRACTION * (high - low) if own.ndim == 1 else 0.0
    return float(low - margin), float(high + margin)


def levels(values: np.ndarray, own: np.ndarray) -> np.ndarray:
    """Return the levels of an answer on the scale of the student's own answer."""
    return drawn(values, np.append(own.ravel(), scale(own)))


def visible(a: np.ndarray, b: np.ndarray) -> bool:
    """Return whether a person sees that two images or curves differ."""
    return bool(np.abs(a.astype(float) - b).mean() > VISIBLE_LEVELS)


def part_means(values: np.ndarray) -> np.ndarray:
    """Return the mean of each part of a curve or an image; values that are not finite count as 0."""
    finite = np.nan_to_num(values.astype(np.float64), posinf=0, neginf=0)
    means = []
    for rows in np.array_split(finite, PARTS_PER_SIDE):
        parts = np.array_split(rows, PARTS_PER_SIDE, axis=1) if rows.ndim > 1 else [rows]
        means += [part.mean() for part in parts]
    return np.array(means)


def gaps(answer: np.ndarray, own: np.ndarray) -> np.ndarray | None:
    """Return the mean difference to the student's own answer in each part, in levels.

    Return None if nobody sees it.
    """
    means = part_means(np.abs(levels(answer, own).astype(float) - levels(own, own)))
    return means if means.max() > VISIBLE_LEVELS_IN_PART else None


def elsewhere(a: np.ndarray, b: np.ndarray) -> bool:
    """Return whether two answers, by their `gaps`, clearly change most in different parts."""
    i = a.argmax()
    j = b.argmax()
    return bool(i != j and a[i] > CLEAR_PART_RATIO * a[j] and b[j] > CLEAR_PART_RATIO * b[i])


def figure(drawn_levels: np.ndarray) -> dict[str, Any]:
    """Return a figure for a page's template, with a description in numbers."""
    percents = 100 / 255 * part_means(drawn_levels)
    description = ", ".join(f"{percent:.0f}" for percent in percents)
    if drawn_levels.ndim > 1:
        uri = web.data_uri(web.encode_webp(drawn_levels, lossless=True))
        return {"image": uri, "size": drawn_levels.shape[1::-1], "parts": description}
    kept = drawn_levels[:: len(drawn_levels) // MAX_CURVE_POINTS + 1]
    points = [
        f"{200 * k / (len(kept) - 1):.1f},{(255 - level) / 2:.1f}" for k, level in enumerate(kept)
    ]
    return {"points": " ".join(points), "size": (200, 128), "parts": description}
