"""Pictures as bytes, for a page: a notebook's frames, a report's illustrations.

image  (H, W) gray or (H, W, 3) RGB, uint8
"""

import base64

import imageio.v3 as iio
import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.uint8]


def webp(image: Image, *, quality: int = 85, lossless: bool = False) -> bytes:
    """Return `image` as WebP, small and quick to decode; lossless suits plots, not photographs."""
    if lossless:
        return iio.imwrite("<bytes>", _rgb(image), extension=".webp", lossless=True)
    return iio.imwrite("<bytes>", _rgb(image), extension=".webp", quality=quality)


def jpeg(image: Image, *, quality: int = 90) -> bytes:
    """Return `image` as JPEG, the quickest to encode, with full colour resolution so that thin lines stay."""
    return iio.imwrite("<bytes>", _rgb(image), extension=".jpg", quality=quality, subsampling=0)


def data_uri(encoded: bytes, kind: str = "webp") -> str:
    """Return bytes as the address of a picture that travels inside the page."""
    return f"data:image/{kind};base64,{base64.b64encode(encoded).decode('ascii')}"


def _rgb(image: Image) -> Image:
    return image if image.ndim == 3 else np.repeat(image[..., None], 3, axis=-1)
