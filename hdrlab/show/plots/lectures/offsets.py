"""Draw a map of values at the offsets (dy, dx) of two photos, with named offsets marked."""

from collections.abc import Mapping

from matplotlib.figure import Figure

from hdrlab.core.arrays import F64

# The width of all plots of the lectures.
WIDTH_INCHES = 5.4
# Marker and size of each named offset.
MARKERS = (("o", 14), ("x", 9))


def draw_offsets(
    values: F64, label: str, marks: Mapping[str, tuple[float, float]] | None
) -> Figure:
    """Return the map of values (2 m + 1, 2 n + 1) at the offsets from (-m, -n) to (m, n)."""
    rows, columns = values.shape
    m = rows // 2
    n = columns // 2
    figure = Figure(figsize=(WIDTH_INCHES, 4.2), dpi=100)
    ax = figure.add_axes((0.13, 0.14, 0.65, 0.82))
    extent = (-n - 0.5, n + 0.5, m + 0.5, -m - 0.5)
    image = ax.imshow(values, extent=extent, interpolation="nearest", aspect="auto")
    marks = marks or {}
    for (name, (dy, dx)), (marker, size) in zip(marks.items(), MARKERS, strict=False):
        ax.plot(dx, dy, marker, label=name, markersize=size, mfc="none", mec="#FFFFFF", mew=2)
    ax.set(xlabel="dx, pixels to the right", ylabel="dy, pixels down")
    figure.colorbar(image, cax=figure.add_axes((0.8, 0.14, 0.035, 0.82)), label=label)
    if marks:
        ax.legend(loc="lower left", facecolor="#404040", labelcolor="#FFFFFF", framealpha=0.8)
    return figure
