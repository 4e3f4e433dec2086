"""Draw images on matplotlib Axes with nearest-neighbor interpolation, faster than `imshow`.

The result equals imshow(interpolation="nearest", aspect="auto") on linear Axes. `imshow` resamples
every image to the size of the screen in floating point, which for a small image takes most of a
plot's time.
"""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.image import AxesImage
from matplotlib.transforms import Affine2D, Bbox
from numpy.typing import ArrayLike, NDArray

# Left, right, bottom and top, in the units of the Axes.
Extent = tuple[float, float, float, float]


class _Nearest(AxesImage):
    """An image (H, W) or (H, W, 3) on linear Axes."""

    def make_image(
        self, renderer: Any, magnification: float = 1.0, unsampled: bool = False
    ) -> tuple[NDArray[np.uint8], float, float, Affine2D]:
        """Return screen pixels (h, w, 4), the lowest row first, their origin, and a transform."""
        visible = Bbox.intersection(self.get_window_extent(), self.axes.bbox)
        x0, y0, x1, y1 = np.array(visible.extents if visible else (0, 0, 0, 0)) * magnification
        across = np.arange(np.floor(x0 + 0.5), np.floor(x1 + 0.5))
        up = np.arange(np.ceil(y0 - 0.5), np.ceil(y1 - 0.5))
        if 0 in (len(across), len(up)):
            return super().make_image(renderer, magnification, unsampled)
        left, right, bottom, top = self.get_extent()
        to_data = self.get_transform().inverted().transform
        x = to_data(np.column_stack([across + 0.5, 0 * across]) / magnification)[:, 0]
        y = to_data(np.column_stack([0 * up, up + 0.5]) / magnification)[:, 1]
        pixels = np.ascontiguousarray(self.to_rgba(np.ma.asarray(self.get_array()), bytes=True))
        h, w = pixels.shape[:2]
        columns = np.clip((x - left) / (right - left) * w, 0, w - 1).astype(int)
        rows = np.clip((y - top) / (bottom - top) * h, 0, h - 1).astype(int)
        # One 32-bit word for each pixel is faster to index than four bytes.
        words = pixels.view(np.uint32)[..., 0]
        screen = words[rows[:, None], columns[None]]
        screen_pixels = screen.view(np.uint8).reshape(*screen.shape, 4)
        return screen_pixels, float(across[0]), float(up[0]), Affine2D()


def show(
    ax: Axes,
    picture: ArrayLike,
    *,
    colours: Any = None,
    norm: Any = None,
    extent: Extent | None = None,
) -> AxesImage:
    """Draw an image with its first row on top.

    `colours` is the color map of values (H, W), and `norm` their scale. The limits of the Axes
    become those of the image, whose pixels have a side of 1 unless an `extent` is given.
    """
    image = _Nearest(ax, cmap=colours, norm=norm, origin="upper", extent=extent, zorder=0)
    image.set_data(picture)
    image.set_clip_path(ax.patch)
    image.set_extent(image.get_extent())
    ax.add_image(image)
    return image
