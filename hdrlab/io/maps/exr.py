"""OpenEXR files, .exr, through the official OpenEXR module, or through `scanlines` where it is missing.

Half, float and unsigned channels, which a file may mix, become float32. R, G and B are a color, Y or
a single channel is a luminance. hdrlab leaves out all other channels, such as alpha (the coverage of
a pixel, whose radiance is in R, G and B), Z (its depth), and those of layers, as most programs do.
The image is the display window. Where the data window is smaller, the rest is 0; where it is larger,
it is cut.
"""

import errno
import io
from collections.abc import Mapping, Sequence
from contextlib import redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from threading import Lock
from typing import Any

import numpy as np

from hdrlab.core.arrays import F32, Array, ArrayLike, Labels, as_radiance
from hdrlab.core.optional import OpenEXR
from hdrlab.core.silence import silence
from hdrlab.errors import FileFormatError, InputError
from hdrlab.io import files
from hdrlab.io.files import check_size, replacing
from hdrlab.io.maps import scanlines

MAGIC = b"v/1\x01"
LARGEST_HALF = 65504.0
# Bytes of pixels for one byte of the file: no compression method reaches more.
BEST_COMPRESSION_RATIO = 2**16
# A display window may be far larger than the data window only if it is small itself.
MAX_LARGE_FRAME_PIXELS = 2**22
MAX_FRAME_TO_DATA_RATIO = 64
# Names of the storages that hdrlab reads.
FLAT_IMAGES = ("scanlineimage", "tiledimage")
# The channels of a color image, in the order of its array.
COLOR_CHANNELS = ("R", "G", "B")
# Differences of color that belong to a luminance Y.
CHROMA_CHANNELS = {"RY", "BY"}
# OpenEXR prints its errors, and all threads share the stream that hdrlab redirects to read them.
STDOUT_LOCK = Lock()

# The header of a part, and its pixels by channel.
Part = tuple[dict[str, Any], dict[str, Array]]


@dataclass(frozen=True)
class Window:
    """A rectangle of pixels: its first row and column, and its size."""

    top: int
    left: int
    height: int
    width: int

    def __str__(self) -> str:
        return f"{self.width} x {self.height} at ({self.left}, {self.top})"


@dataclass(frozen=True)
class Header:
    """What an OpenEXR file states before its pixels.

    `data` and `display` are the data window and the display window.
    """

    channels: tuple[str, ...]
    data: Window
    display: Window
    attributes: dict[str, Any]

    @property
    def is_color(self) -> bool:
        """Whether the image has the channels R, G and B."""
        return set(COLOR_CHANNELS) <= set(self.channels)


def read_header(path: str | Path) -> Header:
    """Return the header of the first part of an OpenEXR file, or raise a FileFormatError."""
    return read_headers(path, 1)[0]


def read_headers(path: str | Path, count: int | None = None) -> list[Header]:
    """Return the headers of the first `count` parts of an OpenEXR file, by default of all.

    Raises
    ------
    FileFormatError
        For a file that is not one, is damaged, or has pixels that hdrlab does not read.
    """
    parts = read_parts(path, count, header_only=True)
    return [_make_header(path, attributes) for attributes, _ in parts]


def _make_header(path: str | Path, attributes: dict[str, Any]) -> Header:
    """Return the header that the attributes of a part make, after a check of what they claim."""
    if attributes["type"].name not in FLAT_IMAGES:
        raise FileFormatError(f"{path}: expected a flat image, got {attributes['type'].name}")
    channels = tuple(name for name, _, _ in attributes["channels"])
    subsampled = [name for name, *steps in attributes["channels"] if steps != [1, 1]]
    if CHROMA_CHANNELS & set(subsampled):
        raise _chroma_error(path, channels)
    if subsampled:
        raise FileFormatError(
            f"{path}: expected channels of full size, got subsampled {', '.join(subsampled)}"
        )
    data = _make_window(path, attributes["dataWindow"], len(channels))
    display = _make_window(path, attributes["displayWindow"], len(channels))
    frame_limit = MAX_FRAME_TO_DATA_RATIO * data.height * data.width
    if display.height * display.width > max(MAX_LARGE_FRAME_PIXELS, frame_limit):
        raise FileFormatError(
            f"{path}: its display window {display} is much larger than its data {data}"
        )
    return Header(channels, data, display, attributes)


def read(path: str | Path) -> F32:
    """Read an OpenEXR file, with the values as they stand in it, NaN and infinity too.

    Parameters
    ----------
    path : the file; of several parts, the first is read

    Returns
    -------
    (H, W, 3) or (H, W) float32, the display window.

    Raises
    ------
    ValueError
        For a file that is not one, is cut short or damaged, or holds other channels than these.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "wall.exr"
    >>> write(file, np.full((2, 3, 3), 0.5))
    >>> read(file).shape
    (2, 3, 3)
    """
    header = read_header(path)
    names = _select_channels(path, header)
    ((_, planes),) = read_parts(path, 1)
    E = stack_channels(planes, names)
    return _place_on_display(path, E, header)


def stack_channels(planes: Mapping[str, Array], names: Sequence[str]) -> F32:
    """Return channels of any types as one array, (H, W) for one of them and else (H, W, n) float32."""
    if len(names) == 1:
        return planes[names[0]].astype(np.float32, copy=False)
    height, width = planes[names[0]].shape
    stacked = np.empty((height, width, len(names)), np.float32)
    for k, name in enumerate(names):
        stacked[..., k] = planes[name]
    return stacked


def _select_channels(path: str | Path, header: Header) -> tuple[str, ...]:
    """Return the names of the channels that are the image: R, G and B, or one of luminance."""
    names = set(header.channels)
    if header.is_color:
        return COLOR_CHANNELS
    if names & CHROMA_CHANNELS:
        raise _chroma_error(path, header.channels)
    if "Y" in names:
        return ("Y",)
    if len(names) == 1:
        return header.channels
    raise FileFormatError(
        f"{path}: expected the channels R, G, B or Y, got {', '.join(header.channels)}"
    )


def _chroma_error(path: str | Path, channels: Sequence[str]) -> FileFormatError:
    """Return the error for an image of luminance and chroma."""
    return FileFormatError(
        f"{path}: it stores color as luminance and chroma ({', '.join(channels)}), "
        "which hdrlab does not read; save it with the channels R, G and B"
    )


def decode_half(bits: Array) -> F32:
    """Return the values (float32) of half floats, given as bits (uint16) of any shape.

    A sign s, an exponent e of 5 bits and a mantissa m of 10 are (-1)^s 2^(e - 15) (1 + m / 1024).
    Where e = 0 they are (-1)^s 2^-14 m / 1024; where e = 31 infinite, or NaN with a mantissa.

    Examples
    --------
    >>> decode_half(np.array([0x3C00, 0xC100, 0x0001], np.uint16)).tolist()
    [1.0, -2.5, 5.960464477539063e-08]
    """
    bits = np.asarray(bits, np.int64)
    sign = 1 - 2 * (bits >> 15)
    e = bits >> 10 & 31
    m = bits & 1023
    value = np.where(e > 0, 1024 + m, 2 * m) * 2.0 ** (e - 25)
    value[e == 31] = np.where(m[e == 31] > 0, np.nan, np.inf)
    return (sign * value).astype(np.float32)


def read_dtypes(path: str | Path) -> tuple[str, ...]:
    """Return the name of each channel's dtype: float16, float32 or uint32."""
    header = read_header(path)
    ((_, planes),) = read_parts(path, 1)
    return tuple(planes[name].dtype.name for name in header.channels)


def write(
    path: str | Path,
    E: ArrayLike,
    *,
    half: bool = False,
    comments: Sequence[str] = (),
    white_luminance: float | None = None,
) -> None:
    """Write radiance as an OpenEXR file of float32, without loss, whole or not at all.

    Parameters
    ----------
    path : the file; what it held is replaced
    E : (H, W) or (H, W, 3) radiance, finite and not negative; one channel is written as Y
    half : True for 16-bit floats: half the size, 3 digits, up to 65504
    comments : sentences for the header's attribute `comments`
    white_luminance : cd/m^2 of white with the value 1, for the standard attribute `whiteLuminance`

    Raises
    ------
    ValueError
        For NaN, infinite or negative values, and with `half` for values above 65504.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "light.exr"
    >>> write(file, [[0.25, 1e6]])
    >>> read(file).tolist()
    [[0.25, 1000000.0]]
    """
    E = as_radiance(E)
    if half and E.max() > LARGEST_HALF:
        raise InputError(
            f"expected radiance up to {LARGEST_HALF:.0f} for half floats, got {E.max():.6g}"
        )
    pixels = np.ascontiguousarray(E, np.float16 if half else np.float32)
    attributes: dict[str, str | float] = {}
    if comments:
        attributes["comments"] = "\n".join(comments)
    if white_luminance is not None:
        attributes["whiteLuminance"] = float(white_luminance)
    planes = split_channels(pixels, "RGB" if E.ndim == 3 else "Y")
    save_parts(path, [scanlines.NewPart(planes, attributes=attributes)])


def split_channels(pixels: Array, names: str) -> dict[str, Array]:
    """Return the channels of an image (H, W) or (H, W, n) by their names, such as RGB."""
    if pixels.ndim == 2:
        return {names: pixels}
    return {name: pixels[..., k] for k, name in enumerate(names)}


def save_parts(path: str | Path, parts: Sequence[scanlines.NewPart]) -> None:
    """Write parts with ZIP compression, whole or not at all."""
    if not OpenEXR:
        files.write(path, scanlines.encode_parts(parts))
        return
    content = [_make_part(part) for part in parts]
    with replacing(path) as name, OpenEXR.File(content) as file:
        try:
            file.write(str(name))
        except RuntimeError as error:
            reason = " ".join(str(error).split())
            raise OSError(errno.EIO, f"{reason} (the disk may be full)", str(path)) from None


def _make_part(part: scanlines.NewPart) -> Any:
    """Return a part as the official module writes it."""
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    planes = {name: np.ascontiguousarray(plane) for name, plane in part.planes.items()}
    return OpenEXR.Part(header | dict(part.attributes), planes, part.name)


def read_parts(
    path: str | Path,
    count: int | None = None,
    *,
    header_only: bool = False,
) -> list[Part]:
    """Return the header and the pixels by channel of the first `count` parts of a file.

    Parameters
    ----------
    path
        The file.
    count
        The number of parts to read, by default all of them.
    header_only
        Whether to leave the pixels out.

    Raises
    ------
    FileFormatError
        For a file that is not OpenEXR, or is damaged.
    """
    with open(path, "rb") as file:  # OpenEXR would call a missing file damaged
        magic = file.read(len(MAGIC))
    if magic != MAGIC:
        raise FileFormatError(f"{path}: expected an OpenEXR file, got {magic!r}")
    if not OpenEXR:
        try:
            return scanlines.read_parts(Path(path).read_bytes(), count, header_only=header_only)
        except FileFormatError as error:
            raise FileFormatError(f"{path}: the OpenEXR file cannot be read ({error})") from None
    open_exr = OpenEXR.File  # outside `try`: it may say what to install
    printed = io.StringIO()
    try:
        with (
            STDOUT_LOCK,
            silence(2),
            redirect_stdout(printed),
            # R, G and B as one array would need one type for all three.
            open_exr(str(path), True, header_only) as exr_file,
        ):
            parts = [_copy_part(part) for part in exr_file.parts[:count]]
            # OpenEXR leaves out a part that it cannot read, and prints why.
            if printed.getvalue() or not parts:
                raise FileFormatError("a part cannot be read")
            return parts
    except Exception as error:  # on damaged files OpenEXR raises exceptions of any type
        reason = printed.getvalue().strip().rpartition(" - ")[2] or str(error)
        raise FileFormatError(
            f"{path}: the OpenEXR file is cut short or damaged ({reason})"
        ) from None


def _copy_part(part: Any) -> Part:
    """Return the header and the pixels of one of OpenEXR's parts."""
    channels = [
        (channel.name, channel.xSampling, channel.ySampling) for channel in part.header["channels"]
    ]
    planes = {name: channel.pixels for name, channel in part.channels.items()}
    return {**part.header, "channels": channels}, planes


def _make_window(path: str | Path, corners: tuple[Labels, Labels], channels: int) -> Window:
    """Return the window between two corners, (left, top) and (right, bottom), and check its size."""
    left, top = corners[0].tolist()
    right, bottom = corners[1].tolist()
    height = bottom - top + 1
    width = right - left + 1
    check_size(path, height, width, height * width * channels // BEST_COMPRESSION_RATIO)
    return Window(top, left, height, width)


def _place_on_display(path: str | Path, E: F32, header: Header) -> F32:
    """Return E, which fills the data window, on the display window."""
    data = header.data
    display = header.display
    if E.shape[:2] != (data.height, data.width):
        raise FileFormatError(
            f"{path}: expected {data.height} x {data.width} pixels of data, got {E.shape[:2]}"
        )
    if data == display:
        return np.ascontiguousarray(E)
    top = data.top - display.top
    left = data.left - display.left
    rows = slice(max(top, 0), min(top + data.height, display.height))
    columns = slice(max(left, 0), min(left + data.width, display.width))
    if rows.start >= rows.stop or columns.start >= columns.stop:
        raise FileFormatError(
            f"{path}: no pixels in its display window {display}, all are in {data}"
        )
    placed = np.zeros((display.height, display.width, *E.shape[2:]), np.float32)
    placed[rows, columns] = E[
        rows.start - top : rows.stop - top, columns.start - left : columns.stop - left
    ]
    return placed
