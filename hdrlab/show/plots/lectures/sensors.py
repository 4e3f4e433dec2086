"""Plot the range of a sensor: clipped pixels, pixels lost in noise, and photon transfer curves.

L      luminance   (K,) or (H, W), cd/m^2
held   pixel values of one exposure: `capture.ranges.ExposedLevels`
full, noise        (H, W) bool, pixels that are full, and pixels that are lost in noise

Full pixels are orange, pixels lost in noise are blue. Their hatching differs, too.
"""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.patheffects import withStroke

from hdrlab.capture import photon_transfer, planning, ranges
from hdrlab.core.arrays import ArrayLike, NDArray, as_picture, describe
from hdrlab.errors import InputError
from hdrlab.show.plots import (
    Ends,
    axes,
    fix_limits,
    logarithmic,
    nearest,
    picture_axes,
    with_legend,
)

# The colors of full pixels, of pixels lost in noise, and of the others.
FULL_COLOR = "#D55E00"
NOISE_COLOR = "#0072B2"
HELD_COLOR = "#B8B8B8"
FULL_RGB = np.array([213, 94, 0], np.uint8)
NOISE_RGB = np.array([0, 114, 178], np.uint8)
# Label, color and hatching of the pixels that are lost in noise, recorded, and full.
PIXEL_KINDS = (
    ("lost in noise", NOISE_COLOR, "///"),
    ("recorded", HELD_COLOR, ""),
    ("full", FULL_COLOR, "..."),
)
BIN_COUNT = 60
# A logarithmic axis cannot begin at 0.
BAR_BOTTOM = 0.7


def mark_lost(picture: ArrayLike, full: ArrayLike, noise: ArrayLike) -> NDArray[np.uint8]:
    """Return a picture (H, W[, 3]) uint8 with full pixels in orange, and those lost in noise in blue."""
    image = as_picture(picture)
    image = np.repeat(image[..., None], 3, axis=-1) if image.ndim == 2 else image.copy()
    for mask, color in ((full, FULL_RGB), (noise, NOISE_RGB)):
        if np.shape(mask) != image.shape[:2]:
            raise InputError(f"expected a mask of shape {image.shape[:2]}, got {describe(mask)}")
        image[np.asarray(mask, bool)] = color
    return image


def window(L: ArrayLike, held: ranges.ExposedLevels, *, limits: Ends = None) -> Axes:
    """Draw the histogram of a scene's luminance, with the pixels that one exposure holds."""
    L = np.asarray(L, np.float64).ravel()
    ax = axes()
    if L.shape != np.shape(held.full) or not np.all(L > 0):
        raise InputError(f"expected positive luminances {np.shape(held.full)}, got {describe(L)}")
    low, high = limits or (float(L.min()), float(L.max()) * 1.0001)
    edges = np.geomspace(low, high, BIN_COUNT + 1)
    below = np.zeros(BIN_COUNT + 1)
    masks = (held.noise & ~held.full, ~held.noise & ~held.full, held.full)
    for (label, color, hatch), mask in zip(PIXEL_KINDS, masks, strict=True):
        counts, _ = np.histogram(L[mask], edges)
        above = below + 100 * np.append(counts, 0) / L.size
        ax.fill_between(
            edges,
            below,
            above,
            step="post",
            label=f"{label}: {mask.mean():.0%}",
            facecolor=color,
            hatch=hatch,
            edgecolor="white",
            linewidth=0,
        )
        below = above
    ax.set(xlabel="luminance, cd/m²", ylabel="pixels, %", xlim=(low, high), ylim=(0, None))
    return logarithmic(with_legend(ax, "upper right"))


def staircase(L: ArrayLike, held: ranges.ExposedLevels) -> Axes:
    """Draw the converter's value over luminance, and the lost ranges [Battiato08 fig. 1.10 to 1.12]."""
    L = np.asarray(L, np.float64)
    ax = axes()
    if L.shape != np.shape(held.Z) or L.ndim != 1:
        raise InputError(f"expected luminances {np.shape(held.Z)}, got {describe(L)}")
    ax.step(L, held.Z, where="mid", color="#1A1A1A", linewidth=1.8)
    noise_kind, _, full_kind = PIXEL_KINDS
    for (label, color, hatch), mask in ((noise_kind, held.noise), (full_kind, held.full)):
        if mask.any():
            lost = L[mask]
            ax.axvspan(
                lost[0], lost[-1], color=color, alpha=0.35, hatch=hatch, linewidth=0, label=label
            )
    ax.set(xlabel="luminance, any unit", ylabel="value of the converter", xlim=(L[0], L[-1]))
    if held.noise.any() or held.full.any():
        with_legend(ax, "upper left")
    return logarithmic(ax)


def transfer(found: photon_transfer.Transfer, *, span: Ends = None, limits: Ends = None) -> Axes:
    """Draw a photon transfer curve: variance over signal, the fitted line, and excluded pairs.

    `span` and `limits` fix the axes, so that a slider turns only the line.
    """
    S = np.maximum(found.S, 0)
    V = found.V
    used = found.used
    ax = axes()
    ax.plot(S[used], V[used], "o", color="#D55E00", label="pairs that are used")
    ax.plot(S[~used], V[~used], "x", color="#0072B2", label="too close to a full well")
    line = np.array([0, S.max()])
    ax.plot(
        line, V[0] + line / found.gain, "-", color="#1A1A1A", label=f"slope 1 / {found.gain:.3g}"
    )
    ax.set(xlabel="signal S, levels above black", ylabel="variance V, levels squared")
    fix_limits(ax, span, limits)
    return with_legend(ax, "upper left")


def coverage(plan: planning.Plan, low: float, high: float) -> Axes:
    """Draw the luminances that each photo of a plan holds, the shortest on top, and the scene's."""
    ax = axes()
    ax.axvspan(low, high, color=HELD_COLOR, alpha=0.45, label="the scene", linewidth=0)
    for row, (name, (dark, bright)) in enumerate(zip(plan.names, plan.holds, strict=True)):
        ax.plot([dark, bright], [row, row], color=NOISE_COLOR, linewidth=7, solid_capstyle="butt")
        ax.annotate(
            f"{name} s", (np.sqrt(dark * bright), row - 0.22), ha="center", va="bottom", fontsize=9
        )
    count = len(plan.names)
    ax.set(
        xlabel="luminance, cd/m²",
        ylabel="photograph",
        yticks=range(count),
        ylim=(count - 0.5, -0.8),
    )
    ax.set(xlim=(low / 200, high * 200), yticklabels=range(1, count + 1))
    return logarithmic(with_legend(ax, "lower right"))


def bars(counts: ArrayLike, *, across: str, up: str, limit: float | None = None) -> Axes:
    """Draw counts as bars on a logarithmic scale, numbered from 1."""
    counts = np.asarray(counts)
    ax = axes()
    x = np.arange(1, len(counts) + 1)
    ax.bar(x, counts, color="#0072B2", bottom=BAR_BOTTOM)
    for place, count in zip(x, counts, strict=True):
        top = BAR_BOTTOM + count
        ax.annotate(f"{count:g}", (place, top), ha="center", va="bottom", fontsize=9)
    ax.set(xlabel=across, ylabel=up, ylim=(BAR_BOTTOM, limit or 3 * counts.max()), xticks=x)
    return logarithmic(ax, "y")


def draw_titled(
    picture: ArrayLike, text: str, *, ring: ArrayLike | None = None, width: float = 5.4
) -> Axes:
    """Draw an image (H, W[, 3]) uint8 below lines of text, with the outline of a region `ring`."""
    image = as_picture(picture)
    image_height = width * image.shape[0] / image.shape[1]
    text_height = 0.25 * (text.count("\n") + 1) + 0.12
    height = image_height + text_height
    ax = picture_axes(width, height, (0, 0, 1, image_height / height))
    nearest.show(ax, image, colours="gray", norm=Normalize(0, 255))
    if ring is not None and 0 < np.asarray(ring, float).mean() < 1:
        edge = ax.contour(np.asarray(ring, float), [0.5], colors="white", linewidths=1.2)
        edge.set_path_effects([withStroke(linewidth=3, foreground="black")])
    ax.text(
        0.01,
        1 - 0.06 / height,
        text,
        va="top",
        fontsize=11.5,
        transform=ax.figure.transFigure,
    )
    return ax
