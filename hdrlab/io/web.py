"""Encode images for web pages and notebooks: WebP, JPEG, runs of one color, half floats.

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

# A plot takes fewer bytes a pixel as runs of one color; a photo takes more than as JPEG.
MAX_RUN_BYTES_PER_PIXEL = 2 / 3
MAX_RUN_PIXELS = 255
# The efforts take half of the time of the encoder's defaults, or less, for 2 to 8 % more bytes.
WEBP_LOSSLESS_METHOD = 1
WEBP_LOSSLESS_EFFORT = 25
WEBP_LOSSY_METHOD = 2


def encode_webp(image: Image, *, quality: int = 85, lossless: bool = False) -> bytes:
    """Return `image` as WebP, which is small and quick to decode.

    `lossless` is for plots, and for pixels whose values a script reads; it ignores `quality`.
    """
    if lossless:
        return _encode(
            image,
            format="WEBP",
            lossless=True,
            method=WEBP_LOSSLESS_METHOD,
            quality=WEBP_LOSSLESS_EFFORT,
        )
    return _encode(image, format="WEBP", lossless=False, method=WEBP_LOSSY_METHOD, quality=quality)


def encode_png(image: Image) -> bytes:
    """Return `image` as PNG, which programs that do not know WebP can read, too."""
    return _encode(image, format="PNG", optimize=True)


def encode_jpeg(image: Image, *, quality: int = 80) -> bytes:
    """Return `image` as JPEG, the quickest to encode.

    Color has full resolution, because thin lines would lose their color otherwise.
    """
    return _encode(image, format="JPEG", quality=quality, subsampling=0)


def encode_runs(image: Image) -> bytes:
    """Return `image` as runs of one color, row after row, which a script paints without a decoder.

    These are words of four bytes, little endian: width, height, and then red, green, blue and
    length of each run, 1 to 255 pixels. Nothing is lost.

    Examples
    --------
    >>> runs = encode_runs(np.full((2, 3), 7, np.uint8))
    >>> np.frombuffer(runs, "<u4").tolist() == [3, 2, 0x06070707]
    True
    """
    h, w = image.shape[:2]
    pixels = np.zeros((h * w, 4), np.uint8)
    pixels[:, :3] = as_rgb(image).reshape(-1, 3)
    colors = pixels.view("<u4")[:, 0]
    is_start = np.ones(h * w, bool)
    is_start[1:] = colors[1:] != colors[:-1]
    is_start[::MAX_RUN_PIXELS] = True
    starts = np.flatnonzero(is_start)
    lengths = np.diff(starts, append=h * w).astype("<u4")
    size = np.array([w, h], "<u4")
    return np.concatenate([size, colors[starts] | lengths << 24]).tobytes()


def encode_frame(image: Image) -> bytes:
    """Return `image` in the encoding that a page shows soonest: runs for plots, JPEG for photos."""
    runs = encode_runs(image)
    height, width = image.shape[:2]
    if len(runs) <= MAX_RUN_BYTES_PER_PIXEL * height * width:
        return runs
    return encode_jpeg(image)


def encode_halves(values: ArrayLike) -> tuple[bytes, float]:
    """Return values (H, W[, 3]) as deflated half floats, and the factor that scaled them.

    The factor is a power of two, which brings the largest value between 16384 and 32768. So no
    value overflows, as a photo of the sun would beyond 65504, and eight decades below the largest
    keep eleven bits. The differences between the bits of neighboring pixels are deflated: first all
    low bytes, then all high bytes.

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
    channels = 3 if values.ndim == 3 else 1
    bits = (values * scale).astype("<f2").view("<u2").reshape(-1, channels)
    steps = np.diff(bits, axis=0, prepend=np.zeros_like(bits[:1]))
    low_and_high_bytes = steps.reshape(-1, 1).view(np.uint8).T
    return zlib.compress(low_and_high_bytes.tobytes()), scale


def decode_picture(encoded: bytes) -> Image:
    """Return the pixels (H, W, 3) of an encoded PNG, JPEG, WebP or GIF.

    Examples
    --------
    >>> decode_picture(encode_webp(np.full((2, 3), 7, np.uint8), lossless=True)).shape
    (2, 3, 3)
    """
    with Pillow.open(io.BytesIO(encoded), formats=("PNG", "JPEG", "WEBP", "GIF")) as image:
        return np.asarray(image.convert("RGB"))


def data_uri(encoded: bytes, kind: str = "webp") -> str:
    """Return an encoded image as a data: URI, which embeds it in a page."""
    return f"data:image/{kind};base64,{base64.b64encode(encoded).decode('ascii')}"


def _encode(image: Image, **options: Any) -> bytes:
    """Return `image` as Pillow encodes it."""
    file = io.BytesIO()
    Pillow.fromarray(as_rgb(image)).save(file, **options)
    return file.getvalue()


def as_rgb(image: Array) -> Array:
    """Return `image` with three channels; a gray one is repeated."""
    if image.ndim == 3:
        return image
    return np.repeat(image[..., None], 3, axis=-1)
