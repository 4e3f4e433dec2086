"""Questions that readers answer before they see the result, which is then shown with their answer.

    predict.number("How many stops are between the window and the bench?", 11.4, (0, 20),
    unit="stops")

Readers answer with pointer, finger or keys, or skip the question with one click. This needs no
kernel. The answer stays in the notebook's own state and is sent nowhere.
"""

import re
from collections.abc import Mapping, Sequence
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

# A larger picture is reduced to the means of k x k pixels.
MAX_PICTURE_SIDE = 960
SLIDER_STEPS = 100
MAX_CURVE_POINTS = 257
MAX_TICKS = 8
LEVEL_TICKS = (0.0, 64.0, 128.0, 192.0, 255.0)
# Names of axes that show pixel values of 8 bits; such an axis is marked at black and at white.
LEVEL_NAME = re.compile(r"\b(?:level|pixel value)\b")
MAX_LEVEL_SPAN = 400


class Prediction(Widget):
    """A question, the true answer `truth`, and the reader's answer `given`, None until there is one."""

    _esm = script(
        "covers.js", "questions.js", "curve_question.js", "place_question.js", "predict.js"
    )
    kind = traitlets.Unicode().tag(sync=True)  # choice, number, entry, curve or place
    question = traitlets.Unicode().tag(sync=True)
    code = traitlets.Unicode().tag(sync=True)  # lines of Python that the question is about
    # whether it covers the cells that follow, and counts on the page
    covers = traitlets.Bool(True).tag(sync=True)
    because = traitlets.Unicode().tag(sync=True)
    truth = traitlets.Any().tag(sync=True)
    told = traitlets.Unicode().tag(sync=True)  # the true answer in words, for some kinds
    labels = traitlets.List(traitlets.Unicode()).tag(sync=True)
    scale = traitlets.List(traitlets.Float()).tag(sync=True)
    ticks = traitlets.List(traitlets.List(traitlets.Float())).tag(sync=True)  # of x and of y
    marks = traitlets.List(traitlets.Dict()).tag(sync=True)  # axis, value, name: of a line
    unit = traitlets.Unicode().tag(sync=True)
    pictures = traitlets.List(traitlets.Bytes()).tag(sync=True)  # WebP
    alts = traitlets.List(traitlets.Unicode()).tag(sync=True)
    given = traitlets.Any(None, allow_none=True).tag(sync=True)
    done = traitlets.Bool(False).tag(sync=True)

    def fallback(self) -> tuple[str, str]:
        """Return the question with an answer that opens on a click, as HTML, and the question."""
        answer = escape(f"{self.told} {self.because}".strip())
        opened = f"<details><summary>Answer</summary>{answer}</details>"
        code = f"<pre>{escape(self.code)}</pre>" if self.code else ""
        return f"<p>{escape(self.question)}</p>{code}{opened}", self.question


def choice(
    question: str,
    truth: int,
    labels: Sequence[str],
    *,
    pictures: Sequence[object] = (),
    because: str = "",
) -> Prediction:
    """Return a multiple-choice question, with or without a picture for each label.

    Parameters
    ----------
    question : str
    truth : int
        Index of the right label.
    labels : at least two str
    pictures : a uint8 picture, Axes or Figure for each label, or none
    because : str
        A sentence that is shown with the answer.

    Raises
    ------
    InputError
        For fewer than two labels, a truth without a label, or another number of pictures.

    Examples
    --------
    >>> choice("Which is brighter?", 0, ["the sky", "the wall"]).labels
    ['the sky', 'the wall']
    """
    has_truth = len(labels) >= 2 and truth in range(len(labels))
    if not has_truth or len(pictures) not in (0, len(labels)):
        raise InputError(
            "expected two or more labels, one of them true, and no pictures or one each, "
            f"got {len(labels)} labels, {len(pictures)} pictures, {truth=}"
        )
    encoded = []
    for picture in pictures:
        small = fit(render(picture), MAX_PICTURE_SIDE // 2)
        encoded.append(web.encode_webp(small, lossless=True))
    return ask(
        "choice",
        question,
        int(truth),
        f"{labels[truth]}.",
        because,
        labels=list(labels),
        alts=list(labels),
        pictures=encoded,
    )


def number(
    question: str, truth: float, between: tuple[float, float], *, unit: str = "", because: str = ""
) -> Prediction:
    """Return a question whose answer is a number on a scale; an error below a tenth of it is small.

    Parameters
    ----------
    question : str
    truth : float
    between : the ends of the scale
    unit : str
    because : str
        A sentence that is shown with the answer.

    Raises
    ------
    InputError
        For a truth that is not on the scale.

    Examples
    --------
    >>> number("How many stops?", 11.4, (0, 20), unit="stops").truth
    11.4
    """
    low, high = map(float, between)
    truth = float(truth)
    if not low <= truth <= high or low == high:
        raise InputError(f"expected a truth between {low:g} and {high:g}, got {truth}")
    is_whole = truth.is_integer() and low.is_integer() and high.is_integer()
    has_whole_steps = is_whole and high - low <= SLIDER_STEPS
    step = 1.0 if has_whole_steps else (high - low) / SLIDER_STEPS
    answer = f"{truth:.3g} {unit}".strip() + "."
    return ask("number", question, truth, answer, because, scale=[low, high, step], unit=unit)


def entry(question: str, truth: float, *, because: str = "") -> Prediction:
    """Return a question whose answer is a number that readers type.

    A whole number must be right. Of others, an error below 2 % is small.

    Parameters
    ----------
    question : str
    truth : float
    because : str
        A sentence that is shown with the answer.

    Raises
    ------
    InputError
        For a truth that is not finite.

    Examples
    --------
    >>> entry("What does hat(5)[1] give?", 0.5).told
    '0.5.'
    """
    truth = float(truth)
    if not np.isfinite(truth):
        raise InputError(f"expected a finite number to type, got {truth}")
    return ask("entry", question, truth, f"{truth:.4g}.", because)


def curve(
    question: str,
    x: ArrayLike,
    y: ArrayLike,
    *,
    names: tuple[str, str],
    because: str = "",
    x_marks: Mapping[float, str] | None = None,
    y_marks: Mapping[float, str] | None = None,
) -> Prediction:
    """Return a question whose answer is a drawn curve y over x, on axes with round ends.

    The widget compares the slope of each third, and separately how far the curve is too high or too
    low. An axis of pixel values has ticks at 0 and 255.

    Parameters
    ----------
    question : str
    x, y : (n,) float
        The true curve, x rising.
    names : the names of x and of y, with their units
    because : str
        A sentence that is shown with the answer.
    x_marks, y_marks : from a value to the name of a line that marks it, optional

    Raises
    ------
    InputError
        For x that does not rise, y that is not finite, or arrays of different lengths.

    Examples
    --------
    >>> curve("Draw it.", [0, 1], [0, 2], names=("level", "light")).scale
    [0.0, 1.0, -0.2, 2.2]
    """
    x = np.asarray(x, np.float64)
    y = np.asarray(y, np.float64)
    has_points = x.shape == y.shape and x.ndim == 1 and len(x) >= 2
    if not has_points or np.any(np.diff(x) <= 0) or not np.isfinite(y).all():
        raise InputError(
            f"expected x (n,) that rises and a finite y (n,), got {describe(x)}, {describe(y)}"
        )
    indices = np.linspace(0, len(x) - 1, MAX_CURVE_POINTS).round().astype(int)
    indices = np.unique(indices)
    margin = 0.1 * (np.ptp(y) or 1.0)
    step = 2 * 10.0 ** np.floor(np.log10(margin))
    low = step * np.floor((y.min() - margin) / step)
    high = step * np.ceil((y.max() + margin) / step)
    x_name, y_name = names
    marks = []
    for axis, named in (("x", x_marks), ("y", y_marks)):
        for value, name in (named or {}).items():
            marks.append({"axis": axis, "value": float(value), "name": name})
    return ask(
        "curve",
        question,
        [x[indices].tolist(), y[indices].tolist()],
        "",
        because,
        scale=[float(x[0]), float(x[-1]), float(low), float(high)],
        labels=[x_name, y_name],
        ticks=[_tick_values(x[0], x[-1], x_name), _tick_values(low, high, y_name)],
        marks=marks,
        alts=[f"Axes: {y_name} over {x_name}"],
    )


def _tick_values(low: float, high: float, name: str) -> list[float]:
    """Return round values on an axis; 0 and 255 are among those of an axis of pixel values."""
    if LEVEL_NAME.search(name) and 128 < high - low < MAX_LEVEL_SPAN:
        return [value for value in LEVEL_TICKS if low <= value <= high]
    power = 10.0 ** np.floor(np.log10((high - low) / MAX_TICKS))
    step = next(k * power for k in (1, 2, 5, 10, 20) if (high - low) / (k * power) <= MAX_TICKS)
    first = int(np.ceil(low / step - 1e-9))
    last = int(np.floor(high / step + 1e-9))
    return [float(k * step) for k in range(first, last + 1)]


def place(
    question: str, mask: ArrayLike, picture: object, *, alt: str, because: str = ""
) -> Prediction:
    """Return a question whose answer is a place in a picture; right are the pixels of the mask.

    Parameters
    ----------
    question : str
    mask : (H, W) bool
    picture : (H, W) or (H, W, 3) uint8
        The picture in which readers mark a pixel.
    alt : str
        What the picture shows.
    because : str
        A sentence that is shown with the answer.

    Raises
    ------
    InputError
        For a mask that is empty or has another size than the picture, or an empty alt text.

    Examples
    --------
    >>> wall = np.full((4, 6), 100, np.uint8)
    >>> place("Where?", wall > 50, wall, alt="A wall").kind
    'place'
    """
    is_right = np.asarray(mask)
    image = render(picture)
    if is_right.dtype != bool or is_right.shape != image.shape[:2] or not is_right.any():
        raise InputError(
            f"expected a mask {image.shape[:2]} with some pixels, got {describe(mask)}"
        )
    small = fit(image, MAX_PICTURE_SIDE)
    height, width = small.shape[:2]
    k = -(-max(is_right.shape) // MAX_PICTURE_SIDE)
    blocks = is_right[: k * height, : k * width].reshape(-1, k, width, k)
    small_mask = np.where(blocks.any(axis=(1, 3)), 255, 0).astype(np.uint8)
    return ask(
        "place",
        question,
        0,
        "",
        because,
        pictures=[web.encode_webp(small), web.encode_webp(small_mask, lossless=True)],
        alts=[require_alt(alt)],
    )


def ask(
    kind: str, question: str, truth: Any, answer: str, because: str, **traits: Any
) -> Prediction:
    """Return a question of a kind, with the true answer as a value and in words."""
    if not question.strip():
        raise InputError("expected a question, got an empty one")
    return Prediction(
        kind=kind, question=question, truth=truth, told=answer, because=because, **traits
    )
