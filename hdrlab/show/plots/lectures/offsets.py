"""A number for each offset (dy, dx) of two photographs -> a map with its scale, and named offsets on it."""

from collections.abc import Mapping

from matplotlib.figure import Figure

from hdrlab.core.arrays import F64

WIDTH = 5.4  # inches, as the other plots have


def draw_offsets(
    values: F64, label: str, marks: Mapping[str, tuple[float, float]] | None
) -> Figure:
    """Return the map of values (2 m + 1, 2 n + 1) at the offsets from (-m, -n) to (m, n)."""
    y, x = (length // 2 for length in values.shape)
    figure = Figure(figsize=(WIDTH, 4.2), dpi=100)
    ax = figure.add_axes((0.13, 0.14, 0.65, 0.82))
    ends = (-x - 0.5, x + 0.5, y + 0.5, -y - 0.5)
    shown = ax.imshow(values, extent=ends, interpolation="nearest", aspect="auto")
    for (name, (dy, dx)), (marker, size) in zip(
        (marks or {}).items(), (("o", 14), ("x", 9)), strict=False
    ):
        ax.plot(dx, dy, marker, label=name, markersize=size, mfc="none", mec="#FFFFFF", mew=2)
    ax.set(xlabel="dx, pixels to the right", ylabel="dy, pixels down")
    figure.colorbar(shown, cax=figure.add_axes((0.8, 0.14, 0.035, 0.82)), label=label)
    if marks:
        ax.legend(loc="lower left", facecolor="#404040", labelcolor="#FFFFFF", framealpha=0.8)
    return figure
