"""Plot least squares in the plane, and the singular values of larger systems.

A      matrix              (m, 2), or (2, 2) where it acts on a circle
b      right-hand side     (m,)
x      unknowns            (2,), a point of the plane
sigma  singular values     (k,), from large to small

Row i of A x = b is a straight line in the plane of x. The points x with the same |A x - b| form an
ellipse. Its axes have the directions of the columns of V, and are longer for smaller singular
values.
"""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes

from hdrlab.core.arrays import ArrayLike, describe
from hdrlab.errors import InputError
from hdrlab.show.plots import LINE_STYLES, SAMPLE_STYLES, axes, with_legend

# Width and height of square plots, in inches.
PLANE_SIZE = (4.4, 4.4)
# Rings of equal residual are drawn at these multiples of the smallest residual.
RING_FACTORS = (1.05, 1.2, 1.5, 2, 3, 4, 6, 9)
# The multiples refer to this residual if the smallest one is below it.
MIN_RING_RESIDUAL = 0.25
# Color and marker of each point.
POINT_STYLES = (("#D55E00", "o"), ("#009E73", "^"), ("#CC79A7", "D"))
CIRCLE_DOTS = 12


def circle(A: ArrayLike, *, marks: ArrayLike | None = None) -> Axes:
    """Draw the image of the unit circle under A, and of two points on it, the columns of `marks`.

    Twelve colored dots mark points of the circle, so that a rotation of it can be seen.
    """
    A = np.asarray(A, np.float64)
    if A.shape != (2, 2) or not np.all(np.isfinite(A)):
        raise InputError(f"expected a finite matrix (2, 2), got {describe(A)}")
    angle = np.linspace(0, 2 * np.pi, 241)
    ring = A @ np.stack([np.cos(angle), np.sin(angle)])
    ax = _plane(3.0, "first component", "second component")
    ax.plot(*ring, color="#1A1A1A", linewidth=1.5)
    ends = np.eye(2) if marks is None else np.asarray(marks, np.float64)
    dots = ring[:, :-1:20]
    ax.scatter(dots[0], dots[1], c=np.arange(CIRCLE_DOTS), cmap="viridis", s=28, zorder=3)
    for end, (color, marker), name in zip(ends.T, SAMPLE_STYLES, ("v1", "v2"), strict=False):
        x, y = A @ end
        (line,) = ax.plot([0, x], [0, y], color=color, linewidth=2, label=f"image of {name}")
        line.set(marker=marker, markevery=[1])
    return with_legend(ax, "upper left")


def equations(
    A: ArrayLike,
    b: ArrayLike,
    points: Mapping[str, ArrayLike] | None = None,
    *,
    reach: float = 4.0,
    names: tuple[str, str] = ("x1", "x2"),
) -> Axes:
    """Draw A x = b as lines, rings of equal |A x - b|, and `points`, each (2,) or (2, K)."""
    A = np.asarray(A, np.float64)
    b = np.asarray(b, np.float64)
    if A.ndim != 2 or A.shape[1] != 2 or b.shape != A.shape[:1]:
        raise InputError(f"expected A (m, 2) and b (m,), got {describe(A)} and {describe(b)}")
    ax = _plane(reach, *names)
    side = np.linspace(-reach, reach, 161)
    grid = np.stack(np.meshgrid(side, side))
    residual = np.sqrt(np.sum((np.tensordot(A, grid, axes=1) - b[:, None, None]) ** 2, axis=0))
    rings = max(float(residual.min()), MIN_RING_RESIDUAL) * np.array(RING_FACTORS)
    ax.contour(side, side, residual, levels=rings, colors="#999999", linewidths=0.8)
    for (p, q), right in zip(A, b, strict=True):
        if p or q:
            nearest_point = np.array([p, q]) * right / (p * p + q * q)
            direction = np.array([-q, p]) / np.hypot(p, q)
            ends = nearest_point[:, None] + direction[:, None] * np.array([-3, 3]) * reach
            ax.plot(*ends, color="#0072B2", linewidth=1.2)
    points = points or {}
    for k, (name, point) in enumerate(points.items()):
        color, marker = POINT_STYLES[k % len(POINT_STYLES)]
        x, y = np.reshape(np.asarray(point, np.float64), (2, -1))
        if len(x) > 1:
            ax.plot(x, y, ".", color=color, markersize=3, label=name)
        else:
            ax.plot(x, y, marker, color=color, markersize=8, label=name)
    return with_legend(ax, "lower left") if points else ax


def spectrum(spectra: Mapping[str, ArrayLike], *, least: float = 1e-17) -> Axes:
    """Draw singular values relative to the largest one over their number, on a decimal log scale.

    Values below `least` are drawn at `least`. The axis is linear in the logarithm, because a slider
    redraws it in half the time of a logarithmic axis.
    """
    ax = axes()
    if not 0 < len(spectra) < len(LINE_STYLES):
        raise InputError(
            f"expected 1 to {len(LINE_STYLES) - 1} systems in one plot, got {len(spectra)}"
        )
    for (color, _), (_, marker), (name, sigma) in zip(
        LINE_STYLES[1:], SAMPLE_STYLES, spectra.items(), strict=False
    ):
        relative = np.asarray(sigma, np.float64) / np.max(sigma)
        decades = np.log10(np.maximum(relative, least))
        numbers = np.arange(1, len(relative) + 1)
        ax.plot(numbers, decades, marker, color=color, markersize=3, label=name)
    ax.set(xlabel="number k of the singular value", ylabel="log10 of σ over the largest")
    ax.set_ylim(np.log10(least) - 0.5, 0.5)
    return with_legend(ax, "lower left")


def _plane(reach: float, across: str, up: str) -> Axes:
    """Return square Axes from -reach to reach."""
    ax = axes(*PLANE_SIZE)
    ax.axhline(0, color="#808080", linewidth=0.8)
    ax.axvline(0, color="#808080", linewidth=0.8)
    ax.set(xlabel=across, ylabel=up, xlim=(-reach, reach), ylim=(-reach, reach))
    return ax
