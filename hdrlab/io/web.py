"""Pictures as bytes, for a page: a notebook's frames, a report's illustrations.

image   (H, W) gray or (H, W, 3) RGB, uint8
values  any shape, finite: radiance, for a script to compute with
"""

import base64
import io
import zlib
from typing import Any

import numpy as np
from PIL import Image as Pillow

from hdrlab.core.arrays import Array, ArrayLike, NDArray

Image = NDArray[np.uint8]

# bytes a pixel, at most: runs of a plot take fewer, those of a photograph more than its JPEG
MAX_RUN_BYTES = 2 / 3


def encode_webp(image: Image, *, quality: int = 85, lossless: bool = False) -> bytes:
    """Return `image` as WebP, small and quick to decode; lossless suits plots, and pixels that are read out.

    The encoder's efforts take half of the time of its defaults, or less, for 2 to 8 % more bytes.
    """
    method, quality = (1, 25) if lossless else (2, quality)
    return _encode(image, format="WEBP", lossless=lossless, method=method, quality=quality)


def encode_jpeg(image: Image, *, quality: int = 80) -> bytes:
    """Return `image` as JPEG, the quickest to encode, with full colour resolution so that thin lines stay."""
    return _encode(image, format="JPEG", quality=quality, subsampling=0)


def encode_runs(image: Image) -> bytes:
    """Return `image` as runs of one colour, row after row, which a script paints at once and without loss.

    These are words of four bytes, little endian: width, height, and then red, green, blue and
    length of each run, 1 to 255 pixels.

    Examples
    --------
    >>> np.frombuffer(encode_runs(np.full((2, 3), 7, np.uint8)), "<u4").tolist() == [3, 2, 0x06070707]
    True
    """
    h, w = image.shape[:2]
    pixels = np.zeros((h * w, 4), np.uint8)
    pixels[:, :3] = as_rgb(image).reshape(-1, 3)
    colours, new = pixels.view("<u4")[:, 0], np.ones(h * w, bool)
    new[1:] = colours[1:] != colours[:-1]
    new[::255] = True
    (starts,) = np.nonzero(new)
    lengths = np.diff(starts, append=h * w).astype("<u4")
    return np.concatenate([np.array([w, h], "<u4"), colours[starts] | lengths << 24]).tobytes()


def encode_frame(image: Image) -> bytes:
    """Return `image` as it is soonest on a page: a plot as its runs, what has too many of these as JPEG."""
    found = encode_runs(image)
    return (
        found
        if len(found) <= MAX_RUN_BYTES * image.shape[0] * image.shape[1]
        else encode_jpeg(image)
    )


def encode_halves(values: ArrayLike) -> tuple[bytes, float]:
    """Return values (H, W[, 3]) times a power of two as half floats, deflated, and that power of two.

    What is deflated is the step of their bits from one pixel to the next: first all low bytes, then
    all high ones. The largest comes to lie between 16384 and 32768, so none overflows, and eight
    decades below it keep eleven bits. A half float ends at 65504, which a photograph of the sun
    does not.

    Examples
    --------
    >>> data, scale = encode_halves([[0.25, 1048576]])
    >>> low, high = np.frombuffer(zlib.decompress(data), np.uint8).reshape(2, -1).astype("<u2")
    >>> (np.cumsum(high << 8 | low, dtype="<u2").view("<f2") / np.float64(scale)).tolist()
    [0.25, 1048576.0]
    """
    values = np.asarray(values, np.float64)
    _, exponent = np.frexp(np.abs(values).max(initial=0))
    scale = float(2.0 ** (15 - int(exponent)))
    bits = (values * scale).astype("<f2").view("<u2").reshape(-1, 3 if values.ndim == 3 else 1)
    steps = np.diff(bits, axis=0, prepend=np.zeros_like(bits[:1]))
    return zlib.compress(steps.reshape(-1, 1).view(np.uint8).T.tobytes()), scale


def decode_picture(encoded: bytes) -> Image:
    """Return what one of these encoders made of a picture, (H, W, 3).

    Examples
    --------
    >>> decode_picture(encode_webp(np.full((2, 3), 7, np.uint8), lossless=True)).shape
    (2, 3, 3)
    """
    with Pillow.open(io.BytesIO(encoded), formats=("PNG", "JPEG", "WEBP", "GIF")) as image:
        return np.asarray(image.convert("RGB"))


def data_uri(encoded: bytes, kind: str = "webp") -> str:
    """Return bytes as the address of a picture that travels inside the page."""
    return f"data:image/{kind};base64,{base64.b64encode(encoded).decode('ascii')}"


def _encode(image: Image, **options: Any) -> bytes:
    Pillow.fromarray(as_rgb(image)).save(file := io.BytesIO(), **options)
    return file.getvalue()


def as_rgb(image: Array) -> Array:
    """Return `image` in three channels."""
    return image if image.ndim == 3 else np.repeat(image[..., None], 3, axis=-1)
