"""Figures for a failed check: the expected answer, the student's answer, and their difference.

expected  (H, W) or (H, W, 3) image, or (n,) curve
answer    the student's answer; its numbers may be of any size, NaN or infinite

An image with a wide range of values is drawn on a logarithmic scale.
"""

import numpy as np
from matplotlib.figure import Figure

from hdrlab.core.arrays import Array, ArrayLike
from hdrlab.errors import InputError
from hdrlab.show import pictures, plots
from hdrlab.show.plots import figures

MIN_SIDE_PIXELS = 200  # a smaller image is enlarged, so that single pixels can be seen
MAX_SIDE_PIXELS = 480
MAX_LINEAR_RATIO = 300.0  # beyond this ratio of largest to smallest the scale is logarithmic
MISSING_GRAY = 128
MIN_RING_RADIUS = 9
RING_HALF_WIDTH = 1.6
PIXEL_LEVELS = 256
MAX_AXIS_LABEL_LENGTH = 28


def image(expected: ArrayLike, answer: ArrayLike, *, what: str = "the answer") -> pictures.Picture:
    """Return expected, answer, and answer - expected with a ring around the worst pixel, side by side.

    Both are drawn with the same black and white. In the difference orange is too large, purple too
    small, and gray is no number.
    """
    truth = np.asarray(expected, np.float64)
    answer = np.asarray(answer, np.float64)
    if truth.shape != answer.shape or truth.ndim not in (2, 3):
        raise InputError(f"expected two images of one shape, got {truth.shape} and {answer.shape}")
    off = _worst_channel(answer - truth)
    place, error = _worst(off)
    scale = ", on a logarithmic scale" if _wide(truth) else ""
    reach = float(np.nanmax(np.abs(np.where(np.isfinite(off), off, np.nan)), initial=0)) or 1.0
    colours = figures.false_colour(
        np.where(np.isfinite(off), off, np.nan), -reach, reach, colours="PuOr_r"
    )
    frames = (
        pictures.encode(_large(drawn(truth, truth))),
        pictures.encode(_large(drawn(answer, truth))),
        pictures.encode(_ringed(colours, place)),
    )
    span = f"from {-reach:.2g} (purple) to {reach:.2g} (orange)"
    captions = (
        "expected",
        "yours",
        f"difference {span}: worst at row {place[0]}, column {place[1]}",
    )
    alts = (
        f"{what}, expected{scale}, {_range(truth)}",
        f"{what}, yours{scale}, {_range(answer)}",
        f"{what}, difference: the worst pixel is row {place[0]}, column {place[1]}, off by {error:.4g}",
    )
    return pictures.Picture(frames, alts, captions)


def curve(expected: ArrayLike, answer: ArrayLike, *, what: str = "the answer") -> pictures.Picture:
    """Return both curves in one plot, with a ring where they are furthest apart, and their difference below.

    What was expected is a broad gray line.
    """
    truth = np.asarray(expected, np.float64)
    answer = np.asarray(answer, np.float64)
    if truth.ndim != 1 or truth.shape != answer.shape:
        raise InputError(f"expected two curves of one length, got {truth.shape} and {answer.shape}")
    (k, _), error = _worst((answer - truth)[:, None])
    seen = np.where(np.isfinite(answer), answer, np.nan)
    reach = 4 * (np.nanmax(truth, initial=-np.inf) - np.nanmin(truth, initial=np.inf) + 1e-9)
    # a single spike would hide everything else
    seen = np.clip(seen, np.nanmin(truth) - reach, np.nanmax(truth) + reach)
    figure = Figure(figsize=(5.4, 4.6), dpi=100, layout="constrained")
    x = np.arange(len(truth))
    ax, below = figure.subplots(2, sharex=True, height_ratios=(5, 2))
    ax.plot(x, truth, "-", color="#B0B0B0", linewidth=5, label="expected")
    ax.plot(x, seen, "-", color="#0072B2", linewidth=1.6, label="yours")
    ax.plot(
        k,
        seen[k],
        "o",
        color="#D55E00",
        markersize=9,
        markerfacecolor="none",
        label="furthest apart",
    )
    plots.with_legend(ax, "best").set(ylabel=what if len(what) < MAX_AXIS_LABEL_LENGTH else "value")
    below.axhline(0, color="#B0B0B0", linewidth=1)
    below.plot(x, seen - truth, "-", color="#D55E00", linewidth=1.6)
    below.set(
        xlabel="level z" if len(truth) == PIXEL_LEVELS else "index", ylabel="yours - expected"
    )
    alt = f"{what}, expected {_range(truth)} and yours {_range(answer)}; at {k} they differ by {error:.4g}"
    caption = f"expected and yours, and below their difference; furthest apart at {k}"
    return pictures.Picture((pictures.encode(figure),), (alt,), (caption,))


def _worst_channel(off: Array) -> Array:
    """Return the error of each pixel's worst channel, (H, W)."""
    if off.ndim == 2:
        return off
    size = np.where(np.isfinite(off), np.abs(off), np.inf)
    return np.take_along_axis(off, size.argmax(axis=-1)[..., None], axis=-1)[..., 0]


def _worst(off: Array) -> tuple[tuple[int, int], float]:
    """Return the place and the size of the largest error; NaN and infinity count as the largest."""
    size = np.where(np.isfinite(off), np.abs(off), np.inf)
    row, column = np.unravel_index(int(np.argmax(size)), size.shape)
    return (int(row), int(column)), float(size[row, column])


def _wide(truth: Array) -> bool:
    light = truth[np.isfinite(truth) & (truth > 0)]
    return bool(
        light.size and np.nanmin(truth) >= 0 and light.max() > MAX_LINEAR_RATIO * light.min()
    )


def drawn(values: Array, truth: Array) -> figures.Image:
    """Return values as a gray or color image, with the black and white levels of `truth`."""
    if _wide(truth):
        floor = truth[truth > 0].min()
        values = np.log2(np.where(values > 0, values, floor))
        truth = np.log2(np.where(truth > 0, truth, floor))
    low = np.nanmin(truth)
    high = np.nanmax(truth)
    with np.errstate(invalid="ignore", over="ignore"):
        levels = 255 * (values - low) / (high - low if high > low else 1)
    return np.where(np.isfinite(levels), np.clip(levels, 0, 255), MISSING_GRAY).astype(np.uint8)


def _large(drawn: figures.Image) -> figures.Image:
    """Return a picture with pixels large enough to be seen one by one, and not too many of them."""
    k = max(1, MIN_SIDE_PIXELS // max(drawn.shape[:2]))
    return figures.fit(drawn.repeat(k, axis=0).repeat(k, axis=1), MAX_SIDE_PIXELS)


def _ringed(colours: figures.Image, place: tuple[int, int]) -> figures.Image:
    """Return the picture in large with a ring around a pixel of the small one."""
    large = _large(colours).copy()
    scale = len(large) / len(colours)
    height, width = large.shape[:2]
    dy = np.arange(height)[:, None] - (place[0] + 0.5) * scale
    dx = np.arange(width)[None, :] - (place[1] + 0.5) * scale
    distance = np.hypot(dy, dx)
    radius = max(0.9 * scale, MIN_RING_RADIUS)
    large[np.abs(distance - radius) < RING_HALF_WIDTH] = 0
    return large


def _range(values: Array) -> str:
    known = values[np.isfinite(values)]
    if known.size == 0:
        return "no numbers"
    missing = values.size - known.size
    text = f"from {known.min():.4g} to {known.max():.4g}"
    return f"{text}, {missing} not finite" if missing else text
