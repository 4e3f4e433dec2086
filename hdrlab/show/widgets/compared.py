"""Widgets that compare pictures of one scene: with a movable edge, or by blinking.

picture  (H, W) or (H, W, 3) uint8, or an Axes or a Figure; all of one size
values   (H, W) or (H, W, 3), any linear unit: values such as radiance that belong to the pixels

Both widgets zoom to single pixels. They show the pixel value, and `values`, under the pointer or
under a cross that the arrow keys move. They need no kernel.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import traitlets

from hdrlab.core.arrays import Array, ArrayLike, describe
from hdrlab.errors import InputError
from hdrlab.io import web
from hdrlab.show.pictures import Picture, render, require_alt
from hdrlab.show.plots.figures import fit
from hdrlab.show.widgets.scripts import Widget, script

# Larger pictures are reduced to the means of k x k pixels, so that a page stays quick to open.
MAX_PICTURE_SIDE = 2000
# More than three flashes in a second can cause seizures [WCAG 2.3.1].
MIN_PERIOD_SECONDS = 0.2


class Comparison(Widget):
    """Pictures of one size, with values that belong to their pixels."""

    pictures = traitlets.List(traitlets.Bytes()).tag(sync=True)  # WebP, without loss
    labels = traitlets.List(traitlets.Unicode()).tag(sync=True)
    alt = traitlets.Unicode().tag(sync=True)
    # half floats: for each picture, or one for all
    values = traitlets.List(traitlets.Bytes()).tag(sync=True)
    scales = traitlets.List(traitlets.Float()).tag(sync=True)
    channels = traitlets.List(traitlets.Int()).tag(sync=True)
    unit = traitlets.Unicode().tag(sync=True)

    def still(self) -> Picture:
        """Return all pictures side by side, with their labels below."""
        alts = tuple(f"{self.alt}: {label}" for label in self.labels)
        return Picture(tuple(self.pictures), alts, tuple(self.labels))


class Wiper(Comparison):
    """Two pictures, the first left of the `edge`, a fraction of the width, the second right of it."""

    _esm = script("half.js", "viewer.js", "wipe.js")
    edge = traitlets.Float(0.5).tag(sync=True)


class Blinker(Comparison):
    """Pictures that blink: one at a time, `index`, for `period` seconds each."""

    _esm = script("half.js", "viewer.js", "blink.js")
    index = traitlets.Int(0).tag(sync=True)
    period = traitlets.Float(0.6).tag(sync=True)


def wipe(
    a: object,
    b: object,
    *,
    alt: str,
    labels: Sequence[str] = ("left", "right"),
    values: ArrayLike | Sequence[ArrayLike] | None = None,
    unit: str = "radiance",
) -> Wiper:
    """Return a widget that shows `a` left of a movable edge and `b` right of it.

    Parameters
    ----------
    a, b : uint8 pictures (H, W) or (H, W, 3), Axes or Figures, of one size
    alt : str
        What the pictures show; the labels and the place of the edge are added.
    labels : two str
        What each picture is.
    values : array (H, W[, 3]), or a list of two such arrays
        Values of the pixels to show, such as the radiance map of both pictures, or a map for each.
    unit : str
        The quantity of `values`.

    Raises
    ------
    InputError
        For pictures or values of different sizes, an empty alt text, or not exactly two labels.

    Examples
    --------
    >>> dark, light = np.full((40, 60), 50, np.uint8), np.full((40, 60), 200, np.uint8)
    >>> wipe(dark, light, alt="A gray wall", labels=["1/60 s", "1/15 s"]).labels
    ['1/60 s', '1/15 s']
    """
    return Wiper(**_make_traits([a, b], alt, labels, values, unit))


def blink(
    a: object,
    b: object,
    *more: object,
    alt: str,
    labels: Sequence[str] | None = None,
    period: float = 0.6,
    values: ArrayLike | Sequence[ArrayLike] | None = None,
    unit: str = "radiance",
) -> Blinker:
    """Return a widget that shows pictures in turn at the same place, so that differences stand out.

    Parameters
    ----------
    a, b, *more : uint8 pictures (H, W) or (H, W, 3), Axes or Figures, of one size
    alt : str
        What the pictures show; the label of the one that is shown is added.
    labels : a str for each picture
        What each picture is; by default A, B and so on.
    period : float
        Seconds for which each picture is shown, 0.2 or more.
    values : array (H, W[, 3]), or a list of such arrays, one for each picture
        Values of the pixels to show, such as the radiance map of all pictures, or a map for each.
    unit : str
        The quantity of `values`.

    Raises
    ------
    InputError
        For pictures or values of different sizes, an empty alt text, a wrong number of labels, or a
        period below 0.2 seconds, whose flashes can cause seizures.

    Examples
    --------
    >>> dark, light = np.full((40, 60), 50, np.uint8), np.full((40, 60), 200, np.uint8)
    >>> blink(dark, light, alt="A gray wall").labels
    ['A', 'B']
    """
    if not MIN_PERIOD_SECONDS <= period < np.inf:
        raise InputError(
            f"expected a period of {MIN_PERIOD_SECONDS} s or more, got {period}: "
            "faster flashes can cause seizures"
        )
    pictures = [a, b, *more]
    if labels is None:
        labels = [chr(ord("A") + k) for k in range(len(pictures))]
    return Blinker(period=period, **_make_traits(pictures, alt, labels, values, unit))


def _make_traits(
    drawings: list[object], alt: str, labels: Sequence[str], values: Any, unit: str
) -> dict[str, Any]:
    """Return the traits of a Comparison, or raise an InputError if its parts do not fit."""
    pictures = [render(drawing) for drawing in drawings]
    sizes = [picture.shape[:2] for picture in pictures]
    if len(set(sizes)) > 1:
        raise InputError(f"expected pictures of one size, got {', '.join(map(str, sizes))}")
    if isinstance(labels, str) or len(labels) != len(pictures) or not all(labels):
        raise InputError(f"expected a label for each of {len(pictures)} pictures, got {labels!r}")
    halves = []
    scales = []
    channels = []
    for array in _list_values(values, len(pictures)):
        _require_values(array, sizes[0])
        data, scale = web.encode_halves(fit(array.astype(np.float32), MAX_PICTURE_SIDE))
        halves.append(data)
        scales.append(scale)
        channels.append(3 if array.ndim == 3 else 1)
    return {
        "pictures": [
            web.encode_webp(fit(picture, MAX_PICTURE_SIDE), lossless=True) for picture in pictures
        ],
        "alt": require_alt(alt),
        "labels": list(labels),
        "values": halves,
        "scales": scales,
        "channels": channels,
        "unit": unit,
    }


def _list_values(values: Any, count: int) -> list[Array]:
    """Return the arrays of values: none, one for all pictures, or one for each."""
    if values is None:
        return []
    arrays = list(values) if isinstance(values, list | tuple) else [values]
    if len(arrays) not in (1, count):
        raise InputError(
            f"expected values for each of {count} pictures, or one array, got {len(arrays)}"
        )
    return [np.asarray(array) for array in arrays]


def _require_values(values: Array, size: tuple[int, ...]) -> None:
    """Raise an InputError if values are not finite numbers with the size of the pictures."""
    has_right_shape = values.shape[:2] == size and values.shape[2:] in ((), (3,))
    is_number = values.dtype.kind in "uif"
    if not has_right_shape or not is_number or not np.isfinite(values).all():
        raise InputError(f"expected finite values {size} or {(*size, 3)}, got {describe(values)}")
