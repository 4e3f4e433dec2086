"""Least squares in the plane, and the singular values of larger systems -> matplotlib Axes.

A      matrix              (m, 2), or (2, 2) where it acts on a circle
b      right-hand side     (m,)
x      unknowns            (2,), a point of the plane
sigma  singular values     (k,), from large to small

Row i of A x = b is a straight line in the plane of x. Where |A x - b| is the same, x lies on an
ellipse; its axes point along the columns of V, and are the longer the smaller their singular value
is.
"""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes

from hdrlab.core.arrays import ArrayLike, describe
from hdrlab.errors import InputError
from hdrlab.show.plots import LINES, SAMPLES, axes, with_legend

SIZE = (4.4, 4.4)  # inches: a step across is as long as one up
RINGS = (1.05, 1.2, 1.5, 2, 3, 4, 6, 9)  # of the least residual, or of 1/4 where that is less


def circle(A: ArrayLike, *, marks: ArrayLike | None = None) -> Axes:
    """Draw what A makes of the unit circle, and of two `marks` on it, its columns; with them the grid turns.

    Twelve dots tell the circle's points apart, so that a rotation of it can be seen.
    """
    A = np.asarray(A, np.float64)
    if A.shape != (2, 2) or not np.all(np.isfinite(A)):
        raise InputError(f"expected a finite matrix (2, 2), got {describe(A)}")
    angle = np.linspace(0, 2 * np.pi, 241)
    ring = A @ np.stack([np.cos(angle), np.sin(angle)])
    ax = _plane(3.0, "first component", "second component")
    ax.plot(*ring, color="#1A1A1A", linewidth=1.5)
    ends = np.eye(2) if marks is None else np.asarray(marks, np.float64)
    ax.scatter(ring[0, :-1:20], ring[1, :-1:20], c=np.arange(12), cmap="viridis", s=28, zorder=3)
    for end, (colour, marker), name in zip(ends.T, SAMPLES, ("v1", "v2"), strict=False):
        x, y = A @ end
        line = ax.plot([0, x], [0, y], color=colour, linewidth=2, label=f"what became of {name}")
        line[0].set(marker=marker, markevery=[1])
    return with_legend(ax, "upper left")


def equations(
    A: ArrayLike,
    b: ArrayLike,
    points: Mapping[str, ArrayLike] | None = None,
    *,
    reach: float = 4.0,
    names: tuple[str, str] = ("x1", "x2"),
) -> Axes:
    """Draw A x = b as lines, rings of equal |A x - b| around the least, and `points`, each (2,) or (2, K)."""
    A = np.asarray(A, np.float64)
    b = np.asarray(b, np.float64)
    if A.ndim != 2 or A.shape[1] != 2 or b.shape != A.shape[:1]:
        raise InputError(f"expected A (m, 2) and b (m,), got {describe(A)} and {describe(b)}")
    ax = _plane(reach, *names)
    side = np.linspace(-reach, reach, 161)
    grid = np.stack(np.meshgrid(side, side))
    residual = np.sqrt(np.sum((np.tensordot(A, grid, axes=1) - b[:, None, None]) ** 2, axis=0))
    rings = max(float(residual.min()), 0.25) * np.array(RINGS)
    ax.contour(side, side, residual, levels=rings, colors="#999999", linewidths=0.8)
    for (p, q), right in zip(A, b, strict=True):
        if p or q:
            foot = np.array([p, q]) * right / (p * p + q * q)
            along = np.array([-q, p]) / np.hypot(p, q)
            ends = foot[:, None] + along[:, None] * np.array([-3, 3]) * reach
            ax.plot(*ends, color="#0072B2", linewidth=1.2)
    for k, (name, at) in enumerate((points or {}).items()):
        colour, marker = (("#D55E00", "o"), ("#009E73", "^"), ("#CC79A7", "D"))[k % 3]
        x, y = np.reshape(np.asarray(at, np.float64), (2, -1))
        many = len(x) > 1
        ax.plot(
            x, y, "." if many else marker, color=colour, markersize=3 if many else 8, label=name
        )
    return with_legend(ax, "lower left") if points else ax


def spectrum(each: Mapping[str, ArrayLike], *, least: float = 1e-17) -> Axes:
    """Draw singular values over their number, as shares of the largest; none stands below `least`.

    Decades are counted on a linear axis, which a slider draws again in half the time.
    """
    ax = axes()
    if not 0 < len(each) < len(LINES):
        raise InputError(f"expected 1 to {len(LINES) - 1} systems in one picture, got {len(each)}")
    for (colour, _), (_, marker), (name, sigma) in zip(
        LINES[1:], SAMPLES, each.items(), strict=False
    ):
        share = np.asarray(sigma, np.float64) / np.max(sigma)
        decades = np.log10(np.maximum(share, least))
        ax.plot(
            np.arange(1, len(share) + 1), decades, marker, color=colour, markersize=3, label=name
        )
    ax.set(xlabel="number k of the singular value", ylabel="log10 of σ over the largest")
    ax.set_ylim(np.log10(least) - 0.5, 0.5)
    return with_legend(ax, "lower left")


def _plane(reach: float, across: str, up: str) -> Axes:
    """Return square Axes from -reach to reach, the same inches for both."""
    ax = axes(*SIZE)
    ax.axhline(0, color="#808080", linewidth=0.8)
    ax.axvline(0, color="#808080", linewidth=0.8)
    ax.set(xlabel=across, ylabel=up, xlim=(-reach, reach), ylim=(-reach, reach))
    return ax
