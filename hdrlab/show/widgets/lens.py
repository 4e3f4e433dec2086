"""The Detail Brush in the browser: `tonemap.brush.lens` follows the pointer over a radiance map.

E  radiance  (H, W) or (H, W, 3), any linear unit; it travels as half floats, scaled to use their range

The script computes what `tonemap.brush` does, by the same formulas, for each frame of the display:
the test compares them pixel by pixel.
"""

from typing import Any

import traitlets

from hdrlab import pipeline
from hdrlab.core.arrays import ArrayLike, as_radiance
from hdrlab.errors import InputError
from hdrlab.io import web
from hdrlab.show.pictures import Picture, render, require_alt
from hdrlab.show.plots.figures import fit
from hdrlab.show.widgets.scripts import Widget, script

SIDE = 1536  # pixels: a larger map is shown by means of k x k pixels
SIZES = (64, 512)  # sides of the brush, pixels
MAGNIFICATIONS = (1, 8)


class Brush(Widget):
    """A radiance map, the picture of it that lies around the brush, and where the brush is."""

    _esm = script("half.js", "brush.js")
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
        """Return the picture that lies around the brush."""
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
    """Return a widget with a brush that equalises the window under it, wherever it is moved.

    Parameters
    ----------
    E : (H, W) or (H, W, 3)
        Radiance; a map of more than 1536 pixels on a side is shown by means of k x k pixels.
    alt : str
        What the map shows; the place of the brush is added.
    picture : uint8 (H, W) or (H, W, 3), optional
        What is seen around the brush; by default `pipeline.develop(E)`.
    size : int
        Side of the brush in pixels, 64 to 512; a slider changes it.
    magnification : int
        Pixels shown for each pixel of E along a side, 1 to 8; a slider changes it.
    limit : float
        How many times an even share a bin of the histogram may count, 1 to 16; a slider changes it.

    Raises
    ------
    ValueError
        For radiance that is not finite or negative, an empty alt text, a picture of another size,
        or knobs out of range.

    Examples
    --------
    >>> import numpy as np
    >>> E = np.geomspace(1, 1e6, 320)[None] * np.ones((240, 1))
    >>> brush(E, alt="A wedge, ever brighter").centre
    [120, 160]
    """
    E = as_radiance(E)
    knobs = {"size": (size, *SIZES), "magnification": (magnification, *MAGNIFICATIONS)}
    for name, (value, low, high) in (knobs | {"limit": (limit, 1, 16)}).items():
        if not low <= value <= high:
            raise InputError(f"expected {name} from {low} to {high}, got {value}")
    around = fit(pipeline.develop(E) if picture is None else render(picture), SIDE)
    E = fit(E, SIDE)
    if around.shape[:2] != E.shape[:2]:
        raise InputError(
            f"expected a picture of the size of E, {E.shape[:2]}, got {around.shape[:2]}"
        )
    data, scale = web.encode_halves(E)
    traits: dict[str, Any] = {"size": size, "magnification": magnification, "limit": limit}
    traits |= {"shape": [*E.shape[:2], 3 if E.ndim == 3 else 1], "radiance": data, "scale": scale}
    traits |= {"centre": [E.shape[0] // 2, E.shape[1] // 2], "alt": require_alt(alt)}
    return Brush(picture=web.encode_webp(around, quality=90), **traits)
