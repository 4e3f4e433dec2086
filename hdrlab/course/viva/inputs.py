"""What a version is asked, made of what the specification asks; and what is shown of its answer.

photo   gray levels of a photograph or an embedded scene, (H, W) uint8
levels  what is drawn of an answer: uint8, (n,) a curve, or (H, W[, 3]) an image
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from hdrlab.course.checks.compare import as_listed
from hdrlab.course.checks.misconceptions import difference
from hdrlab.io import web
from hdrlab.show.plots.differences import drawn

LARGE = 96  # pixels: the longer side of a photograph as functions get it, about
LEAST = SPLIT = 8  # entries of a curve and pixels of an image's side, at least; parts of both
SEEN = 4.5  # levels that two pictures are apart, on average; in one part a third of it
CLEARLY = 1.25  # times as much changes in a version's own part as in another's
APART = 0.02  # relative: numbers that a person tells apart
FINITE = 0.9  # of what is drawn is a number, at least
ROOM = 0.25  # of a curve's range, above it and below


def arrays(change: Callable[[np.ndarray], Any], value: Any) -> Any:
    """Return a value in which each array and number has been changed; texts and flags stay."""
    if isinstance(value, tuple | list):
        return (tuple if isinstance(value, tuple) else list)(arrays(change, one) for one in value)
    if isinstance(value, dict):
        return {name: arrays(change, one) for name, one in value.items()}
    return (
        value
        if value is None or isinstance(value, bool | str | bytes)
        else change(np.asarray(value))
    )


def arrays_in(value: Any) -> list[np.ndarray]:
    """Return the arrays and numbers of a value."""
    found: list[np.ndarray] = []
    arrays(found.append, value)
    return found


def count(value: Any) -> int:
    """Return how many numbers a value holds."""
    return sum(one.size for one in arrays_in(value))


def is_readable(answer: Any, most: int) -> bool:
    """Return whether an answer is a few numbers."""
    finite = all(one.dtype.kind in "biuf" and np.isfinite(one).all() for one in arrays_in(answer))
    return finite and 0 < count(answer) <= most


def digits(array: np.ndarray, n: int) -> np.ndarray:
    """Return an array whose numbers have so many digits, in float64, if they are no integers."""
    rounded = np.vectorize(lambda one: float(f"{one:.{n}g}"), otypes=[float])
    return rounded(array) if array.dtype.kind == "f" else array


def told(value: Any) -> str:
    """Return an answer as it is written in Python, in three digits.

    Examples
    --------
    >>> told((np.array([0.12345, 2]), True, None))
    '([0.123, 2.0], True, None)'
    """
    return repr(arrays(lambda one: digits(one, 3).tolist(), value))


def told_briefly(value: Any, most: int) -> str:
    """Return a value as `told` does, and of one with more numbers than `most` the size and range.

    Examples
    --------
    >>> told_briefly(np.linspace(0, 1, 128).reshape(8, 16), 16)
    '‹8 × 16 numbers from 0 to 1›'
    """
    if count(value) <= most:
        return told(value)
    large = [(" × ".join(map(str, one.shape)), one.min(), one.max()) for one in arrays_in(value)]
    return ", ".join(f"‹{size} numbers from {low:.3g} to {high:.3g}›" for size, low, high in large)


def called(task: str, names: list[str], args: Any, kwargs: dict[str, Any], most: int) -> str:
    """Return a call as it is written, with the names of what is given by its place."""
    given = [*zip(names, args, strict=False), *kwargs.items()]
    return f"{task}({', '.join(f'{name}={told_briefly(one, most)}' for name, one in given)})"


def apart(a: Any, b: Any) -> bool:
    """Return whether a person tells two answers in numbers apart, whichever comes first."""
    return max(difference(a, b), difference(b, a)) > APART


def small(value: Any, side: int = 2) -> Any:
    """Return a value small enough to be gone through by hand: the middle of arrays, in two digits.

    Examples
    --------
    >>> small((np.linspace(0, 1, 9), 0.777))
    (array([0.38, 0.5 ]), 0.78)
    """

    def cut(array: np.ndarray) -> Any:
        middle = [
            slice((n - side) // 2, (n + side) // 2) if n > side + 1 else slice(n)
            for n in array.shape
        ]
        part = digits(array[tuple(middle)], 2).astype(array.dtype)
        return part if part.ndim else part.item()

    return arrays(cut, value)


def photographed(value: Any, photo: np.ndarray) -> Any:
    """Return a value in which each image shows the photograph, in the levels that the image had."""

    def put(image: np.ndarray) -> np.ndarray:
        axes = (-3, -2) if image.ndim > 2 and image.shape[-1] == 3 else (-2, -1)
        if image.ndim < 2 or min(image.shape[axis] for axis in axes) < LEAST:
            return image
        planes = np.moveaxis(image, axes, (-2, -1))
        k = max(1, LARGE // max(planes.shape[-2:]))
        h, w = (k * n for n in planes.shape[-2:])
        few = photo[
            np.ix_(*(np.arange(n) * m // n for n, m in zip((h, w), photo.shape, strict=True)))
        ]
        rank = np.argsort(np.argsort(few, axis=None, kind="stable")) // (k * k)
        levels = np.sort(planes.reshape(*planes.shape[:-2], -1))[..., rank]
        return np.ascontiguousarray(
            np.moveaxis(levels.reshape(*planes.shape[:-2], h, w), (-2, -1), axes)
        )

    return arrays(put, value)


def shown(answer: Any) -> np.ndarray | None:
    """Return what of an answer is an image or a curve, the largest array of the last state; None without."""
    while (
        isinstance(answer := as_listed(answer) if isinstance(answer, list) else answer, list)
        and answer
    ):
        answer = answer[-1]
    every = answer if isinstance(answer, tuple) else (answer,)
    kept = [one for one in every if isinstance(one, np.ndarray)]
    found: np.ndarray = max(kept, key=np.size, default=np.zeros(0))
    while found.ndim > 3 or (found.ndim == 3 and found.shape[-1] != 3):
        found = found[0]
    found = found[:, 0] if found.ndim == 2 and 0 < found.shape[1] <= 3 else found
    large = found.ndim and min(found.shape[:2]) >= LEAST and np.isfinite(found).mean() > FINITE
    return found.astype(np.float64) if large else None


def scale(own: np.ndarray) -> tuple[float, float]:
    """Return which numbers are black and white, or at the foot and the top of a curve's frame."""
    low, high = np.nanmin(own), np.nanmax(own)
    room = ROOM * (high - low) * (own.ndim == 1)
    return float(low - room), float(high + room)


def levels(values: np.ndarray, own: np.ndarray) -> np.ndarray:
    """Return what is drawn of an answer on the scale of the student's own."""
    return drawn(values, np.append(own.ravel(), scale(own)))


def visible(a: np.ndarray, b: np.ndarray) -> bool:
    """Return whether a person sees that two pictures differ."""
    return bool(np.abs(a.astype(float) - b).mean() > SEEN)


def parts(values: np.ndarray) -> np.ndarray:
    """Return the mean of each part, SPLIT of a curve or SPLIT x SPLIT of an image, where no number is 0."""
    rows = np.array_split(np.nan_to_num(values.astype(np.float64), posinf=0, neginf=0), SPLIT)
    split = [np.array_split(row, SPLIT, axis=1) if row.ndim > 1 else [row] for row in rows]
    return np.array([part.mean() for row in split for part in row])


def gaps(came: np.ndarray, own: np.ndarray) -> np.ndarray | None:
    """Return how far an answer is from the student's own, in levels, by parts; None where nobody sees it."""
    found = parts(np.abs(levels(came, own).astype(float) - levels(own, own)))
    return found if found.max() > SEEN / 3 else None


def elsewhere(a: np.ndarray, b: np.ndarray) -> Any:
    """Return whether each of two answers changes most in another part, and clearly so."""
    i, j = a.argmax(), b.argmax()
    return i != j and a[i] > CLEARLY * a[j] and b[j] > CLEARLY * b[i]


def figure(drawn_levels: np.ndarray) -> dict[str, Any]:
    """Return a picture as a page's template draws it, and what it shows in words."""
    about = ", ".join(f"{one:.0f}" for one in 100 / 255 * parts(drawn_levels))
    if drawn_levels.ndim > 1:
        uri = web.data_uri(web.encode_webp(drawn_levels, lossless=True))
        return {"image": uri, "size": drawn_levels.shape[1::-1], "parts": about}
    some = drawn_levels[:: len(drawn_levels) // 256 + 1]
    points = [
        f"{200 * k / (len(some) - 1):.1f},{(255 - one) / 2:.1f}" for k, one in enumerate(some)
    ]
    return {"points": " ".join(points), "size": (200, 128), "parts": about}
