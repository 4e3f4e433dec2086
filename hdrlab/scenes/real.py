"""Real photos: a room with a window, a small tripod by hand, and a studio in all directions.

The room is Axel Jacobs', under CC BY-SA 2.0: `window/README.md`. The tripod is Fran Murcia's, under
the MIT license: `tripod/README.md`. The studio is Poly Haven's, CC0: `probe/README.md`.
"""

from dataclasses import replace

import numpy as np

from hdrlab.core.arrays import F32
from hdrlab.core.bracket import Bracket
from hdrlab.io import photos, radiance
from hdrlab.scenes.places import FOLDER, Shape, resample


def window(shape: Shape | None = None) -> Bracket:
    """Return a real bracket of a dark room with a window: twelve photos from a tripod, a stop apart.

    EXIF states the times, from 1/1000 s to 2 s. A map of them spans 9.6 stops, from the 0.1 % to
    the 99.9 % quantile. Credit: Axel Jacobs, WebHDR, CC BY-SA 2.0.

    Parameters
    ----------
    shape : (H, W), pixels, at most 864 x 1152, which is the default; a smaller one holds means of
        pixel values over areas, see `hdrlab.scenes.layers`

    Returns
    -------
    Bracket of (12, H, W, 3) uint8

    Raises
    ------
    ValueError
        For a shape that is not two numbers from 1 to the size of the photos.

    Examples
    --------
    >>> window((96, 128)).images.shape
    (12, 96, 128, 3)
    """
    return _resize(photos.read_bracket(FOLDER / "window"), shape)


def photographs(shape: Shape | None = None) -> Bracket:
    """Return a real bracket: six photographs of a small tripod before a window, taken from the hand.

    The times are relative, the shortest is 1: they were estimated from the pixels, for the stated
    ones are wrong. So is the contrast of a map made with them: as true as the response of a usual
    camera.

    Parameters
    ----------
    shape : (H, W), pixels, at most 2000 x 1500, which is the default; a smaller one holds means of
        levels
        over areas, see `hdrlab.scenes.layers`

    Returns
    -------
    Bracket of (6, H, W, 3) uint8

    Raises
    ------
    ValueError
        For a shape that is not two numbers from 1 to the size of the photographs.

    Examples
    --------
    >>> photographs((100, 75)).images.shape
    (6, 100, 75, 3)
    """
    taken = photos.read_bracket(FOLDER / "tripod", FOLDER / "tripod/times.csv")
    return _resize(taken, shape)


def _resize(taken: Bracket, shape: Shape | None) -> Bracket:
    """Return a bracket of smaller photos, or the same one for the shape None."""
    if shape is None:
        return taken
    levels = [np.rint(resample(image, shape)).astype(np.uint8) for image in taken.images]
    return replace(taken, images=np.stack(levels))


def probe() -> F32:
    """Return the radiance of a studio from all directions, (64, 128, 3) float32, relative: up, round, colour.

    Row i looks pi (i + 1/2) / 64 from the zenith, and column j looks 2 pi (j + 1/2) / 128 around
    it.

    Examples
    --------
    >>> probe().shape
    (64, 128, 3)
    """
    return radiance.read_radiance(FOLDER / "probe/studio.hdr")
