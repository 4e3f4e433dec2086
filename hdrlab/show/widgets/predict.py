"""Questions that take the answer before the picture comes, and then lay the truth over it.

    predict.number("How many stops lie between the window and the bench?", 11.4, (0, 20),
    unit="stops")

The answer is given by pointer, finger or keys, and skipped by one click; a page without a kernel
will do. What was answered stays in the notebook's own state, and goes nowhere else.
"""

from collections.abc import Sequence
from html import escape
from typing import Any

import numpy as np
import traitlets

from hdrlab.core.arrays import ArrayLike, describe
from hdrlab.errors import InputError
from hdrlab.io import web
from hdrlab.show.pictures import render, require_alt
from hdrlab.show.plots.figures import fit
from hdrlab.show.widgets.scripts import Widget, script

SIDE = 960  # pixels: a larger picture is shown by means of k x k pixels
POSITIONS = 100  # of a number's slider


class Prediction(Widget):
    """A question, what is true, and what was answered: `given` is None before that, and if it was skipped."""

    _esm = script("predict.js")
    kind = traitlets.Unicode().tag(sync=True)  # choice, number, curve or place
    question = traitlets.Unicode().tag(sync=True)
    because = traitlets.Unicode().tag(sync=True)
    truth = traitlets.Any().tag(sync=True)
    told = traitlets.Unicode().tag(sync=True)  # the truth in words, where it has some
    labels = traitlets.List(traitlets.Unicode()).tag(sync=True)
    scale = traitlets.List(traitlets.Float()).tag(sync=True)
    unit = traitlets.Unicode().tag(sync=True)
    pictures = traitlets.List(traitlets.Bytes()).tag(sync=True)  # WebP
    alts = traitlets.List(traitlets.Unicode()).tag(sync=True)
    given = traitlets.Any(None, allow_none=True).tag(sync=True)
    done = traitlets.Bool(False).tag(sync=True)

    def fallback(self) -> tuple[str, str]:
        """Return the question, and its answer to be opened."""
        answer = escape(f"{self.told} {self.because}".strip())
        opened = f"<details><summary>Answer</summary>{answer}</details>"
        return f"<p>{escape(self.question)}</p>{opened}", self.question


def choice(
    question: str,
    truth: int,
    labels: Sequence[str],
    *,
    pictures: Sequence[object] = (),
    because: str = "",
) -> Prediction:
    """Return a question that is answered by one of several labels, with a picture each, or without.

    Parameters
    ----------
    question : str
    truth : int
        Which label is right, from 0.
    labels : str each, at least two
    pictures : a uint8 picture, Axes or Figure for each label, or none
    because : str
        A sentence that is shown with the truth.

    Raises
    ------
    ValueError
        For labels that do not fit the truth or the pictures.

    Examples
    --------
    >>> choice("Which is brighter?", 0, ["the sky", "the wall"]).labels
    ['the sky', 'the wall']
    """
    if len(labels) < 2 or truth not in range(len(labels)) or len(pictures) not in (0, len(labels)):
        wanted = "two or more labels, one of them true, and no pictures or one each"
        raise InputError(
            f"expected {wanted}, got {len(labels)} labels, {len(pictures)} pictures, {truth=}"
        )
    shown = [web.encode_webp(fit(render(one), SIDE // 2), lossless=True) for one in pictures]
    parts = {"labels": list(labels), "alts": list(labels), "pictures": shown}
    return ask("choice", question, int(truth), f"{labels[truth]}.", because, **parts)


def number(
    question: str, truth: float, between: tuple[float, float], *, unit: str = "", because: str = ""
) -> Prediction:
    """Return a question that is answered by a number on a scale; within a tenth of the scale is near.

    Parameters
    ----------
    question : str
    truth : float
    between : the ends of the scale
    unit : str
    because : str
        A sentence that is shown with the truth.

    Raises
    ------
    ValueError
        Where the truth does not lie on the scale.

    Examples
    --------
    >>> number("How many stops?", 11.4, (0, 20), unit="stops").truth
    11.4
    """
    low, high = map(float, between)
    if not low <= truth <= high or low == high:
        raise InputError(f"expected a truth between {low:g} and {high:g}, got {truth}")
    whole = all(one.is_integer() for one in (float(truth), low, high)) and high - low <= POSITIONS
    scale = [low, high, 1.0 if whole else (high - low) / POSITIONS]
    told = f"{truth:.3g} {unit}".strip() + "."
    return ask("number", question, float(truth), told, because, scale=scale, unit=unit)


def curve(
    question: str, x: ArrayLike, y: ArrayLike, *, names: tuple[str, str], because: str = ""
) -> Prediction:
    """Return a question that is answered by drawing: y over x, on axes a little larger, with round ends.

    Parameters
    ----------
    question : str
    x, y : (n,) float
        The true curve, x rising.
    names : of x and of y, with their units
    because : str
        A sentence that is shown with the truth.

    Raises
    ------
    ValueError
        For numbers that are no curve.

    Examples
    --------
    >>> curve("Draw it.", [0, 1], [0, 2], names=("level", "light")).scale
    [0.0, 1.0, -0.2, 2.2]
    """
    x = np.asarray(x, np.float64)
    y = np.asarray(y, np.float64)
    if (
        x.shape != y.shape
        or x.ndim != 1
        or len(x) < 2
        or np.any(np.diff(x) <= 0)
        or not np.isfinite(y).all()
    ):
        raise InputError(
            f"expected x (n,) that rises and a finite y (n,), got {describe(x)}, {describe(y)}"
        )
    few = np.unique(np.linspace(0, len(x) - 1, 257).round().astype(int))
    room = 0.1 * (np.ptp(y) or 1.0)
    step = 2 * 10.0 ** np.floor(np.log10(room))
    low = step * np.floor((y.min() - room) / step)
    high = step * np.ceil((y.max() + room) / step)
    scale = [float(x[0]), float(x[-1]), float(low), float(high)]
    parts = {"scale": scale, "labels": list(names), "alts": [f"Axes: {names[1]} over {names[0]}"]}
    return ask("curve", question, [x[few].tolist(), y[few].tolist()], "", because, **parts)


def place(
    question: str, mask: ArrayLike, picture: object, *, alt: str, because: str = ""
) -> Prediction:
    """Return a question that is answered by marking a pixel: the right ones are those of the mask.

    Parameters
    ----------
    question : str
    mask : (H, W) bool
    picture : (H, W) or (H, W, 3) uint8
        Where to mark it.
    alt : str
        What the picture shows.
    because : str
        A sentence that is shown with the truth.

    Raises
    ------
    ValueError
        For a mask that is empty or does not fit the picture, or an empty alt text.

    Examples
    --------
    >>> wall = np.full((4, 6), 100, np.uint8)
    >>> place("Where?", wall > 50, wall, alt="A wall").kind
    'place'
    """
    right = np.asarray(mask)
    drawn = render(picture)
    if right.dtype != bool or right.shape != drawn.shape[:2] or not right.any():
        raise InputError(
            f"expected a mask {drawn.shape[:2]} with some pixels, got {describe(mask)}"
        )
    small = fit(drawn, SIDE)
    k = -(-max(right.shape) // SIDE)
    rows, columns = (k * side for side in small.shape[:2])
    held = right[:rows, :columns].reshape(-1, k, columns // k, k).any(axis=(1, 3))
    shown = [
        web.encode_webp(small),
        web.encode_webp(np.where(held, 255, 0).astype(np.uint8), lossless=True),
    ]
    return ask("place", question, 0, "", because, pictures=shown, alts=[require_alt(alt)])


def ask(kind: str, question: str, truth: Any, told: str, because: str, **parts: Any) -> Prediction:
    """Return the widget of a kind."""
    if not question.strip():
        raise InputError("expected a question, got an empty one")
    return Prediction(
        kind=kind, question=question, truth=truth, told=told, because=because, **parts
    )
