"""Pictures of one scene, compared pixel by pixel: with a movable edge, or by blinking.

picture  (H, W) or (H, W, 3) uint8, or an Axes or a Figure; all of one size
values   (H, W) or (H, W, 3), any linear unit: what a pixel stands for, read out beside its levels

Both zoom to single pixels and read out the one under the pointer or under the cross that the arrow
keys move. All of it happens in the browser, on a page without a kernel too.
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

# pixels: what is larger is shown by means of k x k pixels, or the page gets too heavy to open
SIDE = 2000
SHORTEST = 0.2  # seconds: more than three flashes in a second can harm a reader [WCAG 2.3.1]


class Comparison(Widget):
    """Pictures of one size, with what their pixels stand for."""

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
    """Two pictures: the first up to the `edge`, a share of the width, and the second from there on."""

    _esm = script("half.js", "viewer.js", "wipe.js")
    edge = traitlets.Float(0.5).tag(sync=True)


class Blinker(Comparison):
    """Pictures in one place, of which `index` is shown; they change every `period` seconds while playing."""

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
        What the pixels stand for, such as the radiance map both pictures were made from, or each
        one's own.
    unit : str
        What `values` are.

    Raises
    ------
    ValueError
        For pictures or values that do not fit together, an empty alt text, or labels that are not
        two.

    Examples
    --------
    >>> dark, light = np.full((40, 60), 50, np.uint8), np.full((40, 60), 200, np.uint8)
    >>> wipe(dark, light, alt="A gray wall", labels=["1/60 s", "1/15 s"]).labels
    ['1/60 s', '1/15 s']
    """
    return Wiper(**_traits([a, b], alt, labels, values, unit))


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
    """Return a widget that shows one picture in the place of the other: what differs jumps to the eye.

    Parameters
    ----------
    a, b, *more : uint8 pictures (H, W) or (H, W, 3), Axes or Figures, of one size
    alt : str
        What the pictures show; the label of the one that is shown is added.
    labels : a str for each picture
        What each picture is; by default A, B and so on.
    period : float
        Seconds that each picture stands while they blink, 0.2 or more.
    values : array (H, W[, 3]), or a list of such arrays, one for each picture
        What the pixels stand for, such as the radiance map all pictures were made from, or each
        one's own.
    unit : str
        What `values` are.

    Raises
    ------
    ValueError
        For pictures or values that do not fit together, an empty alt text, labels that are not one
        for each picture, or a period so short that the flashes can harm.

    Examples
    --------
    >>> dark, light = np.full((40, 60), 50, np.uint8), np.full((40, 60), 200, np.uint8)
    >>> blink(dark, light, alt="A gray wall").labels
    ['A', 'B']
    """
    if not SHORTEST <= period < np.inf:
        raise InputError(
            f"expected a period of {SHORTEST} s or more: faster flashes can harm, got {period}"
        )
    labels = [chr(ord("A") + k) for k in range(2 + len(more))] if labels is None else labels
    return Blinker(period=period, **_traits([a, b, *more], alt, labels, values, unit))


def _traits(
    drawn: list[object], alt: str, labels: Sequence[str], values: Any, unit: str
) -> dict[str, Any]:
    pictures = [render(one) for one in drawn]
    sizes = [picture.shape[:2] for picture in pictures]
    if len(set(sizes)) > 1:
        raise InputError(f"expected pictures of one size, got {', '.join(map(str, sizes))}")
    if isinstance(labels, str) or len(labels) != len(pictures) or not all(labels):
        raise InputError(f"expected a label for each of {len(pictures)} pictures, got {labels!r}")
    read = [_readout(one, sizes[0]) for one in _each(values, len(pictures))]
    return {
        "pictures": [web.encode_webp(fit(picture, SIDE), lossless=True) for picture in pictures],
        "alt": require_alt(alt),
        "labels": list(labels),
        **{name: [one[name] for one in read] for name in ("values", "scales", "channels")},
        "unit": unit,
    }


def _each(values: Any, count: int) -> list[Array]:
    if values is None:
        return []
    each = list(values) if isinstance(values, list | tuple) else [values]
    if len(each) not in (1, count):
        raise InputError(
            f"expected values for each of {count} pictures, or one array, got {len(each)}"
        )
    return [np.asarray(one) for one in each]


def _readout(values: Array, size: tuple[int, ...]) -> dict[str, Any]:
    fits = (
        values.shape[:2] == size and values.shape[2:] in ((), (3,)) and values.dtype.kind in "uif"
    )
    if not fits or not np.isfinite(values).all():
        raise InputError(f"expected finite values {size} or {(*size, 3)}, got {describe(values)}")
    data, scale = web.encode_halves(fit(values.astype(np.float32), SIDE))
    return {"values": data, "scales": scale, "channels": 3 if values.ndim == 3 else 1}
