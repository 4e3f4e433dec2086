"""Plot colors of skin: the plane of chrominance, and the skin locus.

Z     image, or training pixels    (..., 3) pixel values 0 to 255, sRGB
x     chrominance (..., 2), (Cb, Cr) at luma 128
r, g  fractions of red and green
"""

import numpy as np
from matplotlib.axes import Axes

from hdrlab.core.arrays import F64, ArrayLike, describe
from hdrlab.enhance import skin
from hdrlab.errors import InputError
from hdrlab.show.plots import BLACK, axes, with_legend

# More dots would hide one another.
MAX_DOTS = 2000
DOT_COLOR = "#56B4E9"
BOUNDARY_COLOR = "#D55E00"


def _pixels(Z: ArrayLike) -> F64:
    """Return up to MAX_DOTS pixels (N, 3), evenly from all."""
    Z = np.asarray(Z, np.float64)
    if Z.shape[-1:] != (3,) or Z.size == 0:
        raise InputError(f"expected pixels (..., 3), got {describe(Z)}")
    pixels = Z.reshape(-1, 3)
    step = -(-len(pixels) // MAX_DOTS)
    return pixels[::step]


def chrominance(Z: ArrayLike, known: skin.Skin, *, reach: float = skin.MAX_DISTANCE) -> Axes:
    """Draw the chrominance of pixels, and the ellipse within `reach` of the Gaussian of skin."""
    x = skin.chrominance(_pixels(Z))
    ax = axes(4.6, 4.2)
    angle = np.linspace(0, 2 * np.pi, 200)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    ellipse = known.mu + reach * circle @ np.linalg.cholesky(known.S).T
    ax.plot(*x.T, ".", color=DOT_COLOR, markersize=2, label="pixels")
    ax.plot(*ellipse.T, color=BOUNDARY_COLOR, linewidth=2, label=f"Mahalanobis {reach:g}")
    ax.plot(*known.mu, "+", color=BLACK, markersize=10, label="mean of skin")
    ax.set(xlabel="Cb at luma 128", ylabel="Cr at luma 128", xlim=(-60, 60), ylim=(-40, 80))
    return with_legend(ax, "lower left")


def locus(Z: ArrayLike) -> Axes:
    """Draw the fractions of red and green of pixels, and the parabolas of the skin locus [Soriano03]."""
    Z = _pixels(Z)
    ax = axes(4.6, 4.2)
    total = np.maximum(Z.sum(axis=1), 1)
    r = Z[:, 0] / total
    g = Z[:, 1] / total
    x = np.linspace(0.2, 0.65, 100)
    upper = np.polyval(skin.UPPER, x)
    lower = np.polyval(skin.LOWER, x)
    ax.plot(r, g, ".", color=DOT_COLOR, markersize=2, label="pixels")
    ax.plot(x, upper, "-", color=BOUNDARY_COLOR, linewidth=2, label="above: no skin")
    ax.plot(x, lower, "--", color=BLACK, linewidth=2, label="below: no skin")
    ax.set(
        xlabel="fraction of red, r",
        ylabel="fraction of green, g",
        xlim=(0.2, 0.65),
        ylim=(0.1, 0.5),
    )
    return with_legend(ax, "upper right")
