"""Draw which pixels of a mosaic give one of its pixels the two colors that its filter did not measure.

X        mosaic    (H, W), 0 to 1
c        channels  (H, W) int, 0 to 2: the color of each pixel's filter
W        weights   (3, H, W), of all pixels in the three channels of one pixel
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle
from matplotlib.patheffects import withStroke

from hdrlab.core.arrays import F32, F64, Array, ArrayLike
from hdrlab.core.colour import encode_srgb
from hdrlab.core.filters.mosaic import as_channels
from hdrlab.errors import InputError
from hdrlab.show.plots import picture_axes

# These pixels at each side of a mosaic are not drawn: they are neighbors of those that are.
MARGIN = 2
CELL_INCHES = 0.78
CHANNEL_NAMES = "RGB"
# A weight below this is a rounding error.
MIN_WEIGHT = 1e-6
MAX_DENOMINATOR = 16
LABEL_SIZE = 11
# A black pixel gets this much of the color of its filter.
MIN_TINT = 0.15
OUTLINE = withStroke(linewidth=2.5, foreground="#1A1A1A")


@dataclass(frozen=True, kw_only=True)
class Neighbors:
    """One pixel of a mosaic, its three channels, and the weights of all pixels in each of them."""

    mosaic: Array  # (H, W)
    channels: Array  # (H, W)
    y: int
    x: int
    weights: F64  # (3, H, W)
    color: F64  # (3,)


def find_neighbors(
    X: ArrayLike,
    c: ArrayLike,
    demosaic: Callable[[Array, Array], Array],
    *,
    down: float,
    right: float,
) -> Neighbors:
    """Return the weights of all pixels in one of them, for a demosaicing that is linear.

    Parameters
    ----------
    X : (H, W), mosaic; two pixels at each side belong to the margin
    c : (H, W) int, channels of the filters
    demosaic : function of a mosaic and its channels
    down, right : the pixel, as fractions of the mosaic without its margin, from 0 to 1
    """
    X = np.asarray(X, np.float64)
    c = as_channels(c, X.shape)
    height = X.shape[0] - 2 * MARGIN
    width = X.shape[1] - 2 * MARGIN
    if height < 1 or width < 1 or not (0 <= down <= 1 and 0 <= right <= 1):
        raise InputError(
            f"expected a mosaic of more than {2 * MARGIN} pixels a side, and fractions from 0 to 1"
        )
    y = MARGIN + min(int(down * height), height - 1)
    x = MARGIN + min(int(right * width), width - 1)
    weights = np.zeros((3, *X.shape))
    for j in range(y - MARGIN, y + MARGIN + 1):
        for i in range(x - MARGIN, x + MARGIN + 1):
            impulse = np.zeros(X.shape)
            impulse[j, i] = 1
            weights[:, j, i] = demosaic(impulse, c)[y, x]
    color = (weights * X).sum(axis=(1, 2))
    return Neighbors(mosaic=X, channels=c, y=y, x=x, weights=weights, color=color)


def tint_mosaic(X: ArrayLike, c: ArrayLike) -> F32:
    """Return a mosaic (H, W) as an image (H, W, 3), each pixel in the color of its filter."""
    X = np.asarray(X, np.float32)
    return X[..., None] * np.eye(3, dtype=np.float32)[as_channels(c, X.shape)]


def draw_neighbors(found: Neighbors) -> Axes:
    """Draw the mosaic around a pixel, and on each neighbor its weight in the two missing channels."""
    inside = slice(MARGIN, -MARGIN)
    brightness = MIN_TINT + (1 - MIN_TINT) * encode_srgb(np.clip(found.mosaic, 0, 1))
    shown = tint_mosaic(brightness, found.channels)[inside, inside]
    height, width = shown.shape[:2]
    ax = picture_axes(CELL_INCHES * width, CELL_INCHES * height, (0, 0, 1, 1))
    ax.imshow(shown, interpolation="nearest", aspect="auto")
    measured = int(found.channels[found.y, found.x])
    missing = [k for k in range(3) if k != measured]
    for y in range(height):
        for x in range(width):
            at = (y + MARGIN, x + MARGIN)
            if at == (found.y, found.x):
                continue
            weights = [(k, found.weights[(k, *at)]) for k in missing]
            lines = [
                f"{CHANNEL_NAMES[k]} {write_fraction(weight)}"
                for k, weight in weights
                if abs(weight) > MIN_WEIGHT
            ]
            _write(ax, x, y, "\n".join(lines))
    own = []
    for k in range(3):
        sign = "=" if k == measured else "≈"
        own.append(f"{CHANNEL_NAMES[k]} {sign} {found.color[k]:.2f}")
    left = found.x - MARGIN - 0.5
    top = found.y - MARGIN - 0.5
    ax.add_patch(Rectangle((left, top), 1, 1, fill=False, edgecolor="white", linewidth=3))
    _write(ax, found.x - MARGIN, found.y - MARGIN, "\n".join(own))
    return ax


def write_fraction(weight: float) -> str:
    """Return a weight as a fraction with a sign.

    Examples
    --------
    >>> write_fraction(0.25), write_fraction(-0.1875), write_fraction(1)
    ('+1/4', '−3/16', '+1')
    """
    fraction = Fraction(weight).limit_denominator(MAX_DENOMINATOR)
    sign = "−" if fraction < 0 else "+"
    return f"{sign}{abs(fraction)}"


def _write(ax: Axes, x: int, y: int, text: str) -> None:
    """Write white text with a dark outline into the middle of a cell."""
    ax.text(
        x,
        y,
        text,
        color="white",
        fontsize=LABEL_SIZE,
        ha="center",
        va="center",
        path_effects=[OUTLINE],
        fontweight="bold",
    )
