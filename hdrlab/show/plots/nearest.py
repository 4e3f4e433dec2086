"""Pictures on matplotlib Axes: each pixel of the screen takes the colour of the pixel in which it lies.

This is imshow(interpolation="nearest", aspect="auto") on linear Axes, and looks the same.
matplotlib brings every picture to the screen's size in floating point, which for a small one takes
most of a plot's time.
"""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.image import AxesImage
from matplotlib.transforms import Affine2D, Bbox
from numpy.typing import ArrayLike, NDArray

Extent = tuple[float, float, float, float]  # left, right, bottom, top, in the units of the Axes


class _Nearest(AxesImage):
    """A picture (H, W) or (H, W, 3) on linear Axes."""

    def make_image(
        self, renderer: Any, magnification: float = 1.0, unsampled: bool = False
    ) -> tuple[NDArray[np.uint8], float, float, Affine2D]:
        """Return the pixels of the screen (h, w, 4), the lowest row first, and where on it they begin."""
        seen = Bbox.intersection(self.get_window_extent(), self.axes.bbox)
        x0, y0, x1, y1 = np.array(seen.extents if seen else (0, 0, 0, 0)) * magnification
        across = np.arange(np.floor(x0 + 0.5), np.floor(x1 + 0.5))
        up = np.arange(np.ceil(y0 - 0.5), np.ceil(y1 - 0.5))
        if 0 in (len(across), len(up)):
            return super().make_image(renderer, magnification, unsampled)
        left, right, bottom, top = self.get_extent()
        place = self.get_transform().inverted().transform
        x = place(np.column_stack([across + 0.5, 0 * across]) / magnification)[:, 0]
        y = place(np.column_stack([0 * up, up + 0.5]) / magnification)[:, 1]
        pixels = np.ascontiguousarray(self.to_rgba(np.ma.asarray(self.get_array()), bytes=True))
        h, w = pixels.shape[:2]
        columns = np.clip((x - left) / (right - left) * w, 0, w - 1).astype(int)
        rows = np.clip((y - top) / (bottom - top) * h, 0, h - 1).astype(int)
        words = pixels.view(np.uint32)[..., 0]  # one for each pixel
        shown = words[rows[:, None], columns[None]]
        return (
            shown.view(np.uint8).reshape(*shown.shape, 4),
            float(across[0]),
            float(up[0]),
            Affine2D(),
        )


def show(
    ax: Axes,
    picture: ArrayLike,
    *,
    colours: Any = None,
    norm: Any = None,
    extent: Extent | None = None,
) -> AxesImage:
    """Draw a picture, its first row on top; values (H, W) have `colours`, whose ends the `norm` says.

    The limits of the Axes follow the picture, whose pixels have a side of 1 unless an `extent` is
    given.
    """
    image = _Nearest(ax, cmap=colours, norm=norm, origin="upper", extent=extent, zorder=0)
    image.set_data(picture)
    image.set_clip_path(ax.patch)
    image.set_extent(image.get_extent())
    ax.add_image(image)
    return image
