"""The Detail Brush as a widget: `tonemap.brush.lens` follows the pointer over a radiance map.

E  radiance  (H, W) or (H, W, 3), any linear unit; the page stores it as scaled half floats

The script uses the formulas of `tonemap.brush` for each frame of the display. A test compares the
two pixel by pixel.
"""

import traitlets

from hdrlab import pipeline
from hdrlab.core.arrays import ArrayLike, as_radiance
from hdrlab.errors import InputError
from hdrlab.io import web
from hdrlab.show.pictures import Picture, render, require_alt
from hdrlab.show.plots.figures import fit
from hdrlab.show.widgets.scripts import Widget, script

# A larger map is reduced to the means of k x k pixels.
MAX_MAP_SIDE = 1536
# The smallest and the largest value of each parameter.
SIZE_RANGE = (64, 512)
MAGNIFICATION_RANGE = (1, 8)
LIMIT_RANGE = (1, 16)


class Brush(Widget):
    """A radiance map, the picture that surrounds the brush, and the place of the brush."""

    _esm = script("half.js", "srgb.js", "brush.js")
    radiance = traitlets.Bytes().tag(sync=True)  # half floats (H, W, channels)
    scale = traitlets.Float(1.0).tag(sync=True)
    shape = traitlets.List(traitlets.Int()).tag(sync=True)
    picture = traitlets.Bytes().tag(sync=True)  # WebP
    alt = traitlets.Unicode().tag(sync=True)
    bins = traitlets.Int(1024).tag(sync=True)
    centre = traitlets.List(traitlets.Int()).tag(sync=True)  # (y, x)
    size = traitlets.Int(256).tag(sync=True)
    magnification = traitlets.Int(1).tag(sync=True)
    limit = traitlets.Float(4.0).tag(sync=True)

    def still(self) -> Picture:
        """Return the picture that surrounds the brush."""
        return Picture((self.picture,), (self.alt,), ("",))


def brush(
    E: ArrayLike,
    *,
    alt: str,
    picture: object = None,
    size: int = 256,
    magnification: int = 1,
    limit: float = 4.0,
) -> Brush:
    """Return a widget with a brush that equalizes the histogram of the window under it.

    Parameters
    ----------
    E : (H, W) or (H, W, 3)
        Radiance; a map of more than 1536 pixels on a side is reduced to means of k x k pixels.
    alt : str
        What the map shows; the place of the brush is added.
    picture : uint8 (H, W) or (H, W, 3), optional
        The picture that surrounds the brush; by default `pipeline.develop(E)`.
    size : int
        Side of the brush in pixels, 64 to 512; a slider changes it.
    magnification : int
        Pixels shown for each pixel of E along a side, 1 to 8; a slider changes it.
    limit : float
        Largest count of a histogram bin, as a multiple of the mean count, 1 to 16; a slider changes
        it.

    Raises
    ------
    InputError
        For radiance that is not finite or negative, an empty alt text, a picture of another size,
        or parameters out of range.

    Examples
    --------
    >>> import numpy as np
    >>> E = np.geomspace(1, 1e6, 320)[None] * np.ones((240, 1))
    >>> brush(E, alt="A wedge, ever brighter").centre
    [120, 160]
    """
    E = as_radiance(E)
    _require_in_range("size", size, SIZE_RANGE)
    _require_in_range("magnification", magnification, MAGNIFICATION_RANGE)
    _require_in_range("limit", limit, LIMIT_RANGE)
    image = pipeline.develop(E) if picture is None else render(picture)
    image = fit(image, MAX_MAP_SIDE)
    E = fit(E, MAX_MAP_SIDE)
    if image.shape[:2] != E.shape[:2]:
        raise InputError(
            f"expected a picture of the size of E, {E.shape[:2]}, got {image.shape[:2]}"
        )
    height, width = E.shape[:2]
    data, scale = web.encode_halves(E)
    return Brush(
        radiance=data,
        scale=scale,
        shape=[height, width, 3 if E.ndim == 3 else 1],
        picture=web.encode_webp(image, quality=90),
        alt=require_alt(alt),
        centre=[height // 2, width // 2],
        size=size,
        magnification=magnification,
        limit=limit,
    )


def _require_in_range(name: str, value: float, ends: tuple[int, int]) -> None:
    low, high = ends
    if not low <= value <= high:
        raise InputError(f"expected {name} from {low} to {high}, got {value}")
