"""The colours of skin -> matplotlib Axes: the plane of chrominance, and the skin locus.

Z    picture, or training pixels    (..., 3) levels 0 to 255, sRGB
x    chrominance (..., 2), (Cb, Cr) at level 128;  r, g  shares of red and green
"""

import numpy as np
from matplotlib.axes import Axes

from hdrlab.core.arrays import F64, ArrayLike, describe
from hdrlab.enhance import skin
from hdrlab.errors import InputError
from hdrlab.show.plots import axes, with_legend

MOST = 2000  # pixels: more dots hide one another
PALE = "#56B4E9"
DARK = "#1A1A1A"
RUST = "#D55E00"


def _pixels(Z: ArrayLike) -> F64:
    """Return up to MOST pixels (N, 3), evenly from the whole."""
    Z = np.asarray(Z, np.float64)
    if Z.shape[-1:] != (3,) or Z.size == 0:
        raise InputError(f"expected pixels (..., 3), got {describe(Z)}")
    return Z.reshape(-1, 3)[:: -(-Z.size // 3 // MOST)]


def chrominance(Z: ArrayLike, known: skin.Skin, *, reach: float = skin.MAX_DISTANCE) -> Axes:
    """Draw the chrominance of pixels, and the ellipse within `reach` of the Gaussian of skin."""
    x = skin.chrominance(_pixels(Z))
    ax = axes(4.6, 4.2)
    turn = np.linspace(0, 2 * np.pi, 200)
    edge = (
        known.mu
        + reach * np.stack([np.cos(turn), np.sin(turn)], axis=-1) @ np.linalg.cholesky(known.S).T
    )
    ax.plot(*x.T, ".", color=PALE, markersize=2, label="pixels")
    ax.plot(*edge.T, color=RUST, linewidth=2, label=f"Mahalanobis {reach:g}")
    ax.plot(*known.mu, "+", color=DARK, markersize=10, label="mean of skin")
    ax.set(xlabel="Cb at level 128", ylabel="Cr at level 128", xlim=(-60, 60), ylim=(-40, 80))
    return with_legend(ax, "lower left")


def locus(Z: ArrayLike) -> Axes:
    """Draw the shares of red and green of pixels, and the two parabolas of the skin locus [Soriano03]."""
    Z = _pixels(Z)
    ax = axes(4.6, 4.2)
    r, g = (Z[:, :2] / np.maximum(Z.sum(axis=1), 1)[:, None]).T
    across = np.linspace(0.2, 0.65, 100)
    ax.plot(r, g, ".", color=PALE, markersize=2, label="pixels")
    ax.plot(
        across, np.polyval(skin.UPPER, across), "-", color=RUST, linewidth=2, label="above: no skin"
    )
    ax.plot(
        across,
        np.polyval(skin.LOWER, across),
        "--",
        color=DARK,
        linewidth=2,
        label="below: no skin",
    )
    ax.set(xlabel="share of red, r", ylabel="share of green, g", xlim=(0.2, 0.65), ylim=(0.1, 0.5))
    return with_legend(ax, "upper right")
