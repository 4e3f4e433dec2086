"""OpenEXR files, .exr, through the official OpenEXR module.

Half, float and unsigned channels become float32; R, G and B make a colour, Y or a channel alone a
luminance. An alpha channel is left out: it says how much a pixel covers, and its radiance stands in
R, G and B. The picture is the display window: where the data window is smaller, the rest is 0;
where larger, it is cut.
"""

import errno
import io
from collections.abc import Sequence
from contextlib import redirect_stdout
from pathlib import Path
from threading import Lock
from typing import Any, NamedTuple

import numpy as np

from hdrlab.core.arrays import F32, Array, ArrayLike, Labels, as_radiance
from hdrlab.core.optional import OpenEXR
from hdrlab.core.silence import silence
from hdrlab.errors import FileFormatError
from hdrlab.io.files import check_size, replacing

LARGEST_HALF = 65504.0
# bytes of a picture in one of the file: more than any of the methods reaches
BEST_COMPRESSION_RATIO = 1 << 16
# pixels of a window that holds more than so many times the data's: more is no frame around a
# picture
LARGEST_FRAME, FRAME_RATIO = 1 << 22, 64
PRINTING = Lock()  # OpenEXR prints what is wrong, and the stream that catches it is everybody's
Part = tuple[dict[str, Any], dict[str, Array]]
COLOURS = ({"R", "G", "B"}, {"R", "G", "B", "A"})


class Window(NamedTuple):
    """A rectangle of pixels: its first row and column, and its size."""

    top: int
    left: int
    height: int
    width: int


class Header(NamedTuple):
    """What an OpenEXR file says before its pixels: its channels, the two windows, and all its attributes."""

    channels: tuple[str, ...]
    data: Window
    display: Window
    attributes: dict[str, Any]


def read_header(path: str | Path) -> Header:
    """Return the Header of the first part of the OpenEXR file at `path`, or raise a ValueError."""
    return read_headers(path, 1)[0]


def read_headers(path: str | Path, count: int | None = None) -> list[Header]:
    """Return the Header of each of the first `count` parts of the OpenEXR file, or raise a ValueError."""
    return [_header(path, attributes) for attributes, _ in parts(path, count, header_only=True)]


def _header(path: str | Path, attributes: dict[str, Any]) -> Header:
    """Return the Header that the attributes of a part make, after a look at what they claim."""
    if attributes["type"] not in (OpenEXR.scanlineimage, OpenEXR.tiledimage):
        raise FileFormatError(f"{path}: expected a flat image, got {attributes['type'].name}")
    channels, across, down = zip(*attributes["channels"], strict=True)
    if {*across, *down} != {1}:
        raise FileFormatError(
            f"{path}: expected channels of full size, got subsampled {', '.join(channels)}"
        )
    windows = (attributes["dataWindow"], attributes["displayWindow"])
    data, display = (_window(path, window, len(channels)) for window in windows)
    if display.height * display.width > max(LARGEST_FRAME, FRAME_RATIO * data.height * data.width):
        raise FileFormatError(
            f"{path}: expected a display window not far beyond {data}, got {display}"
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
    names = set(header.channels)
    if names not in COLOURS and names - {"A"} != {"Y"} and len(names) != 1:
        raise FileFormatError(
            f"{path}: expected the channels R, G, B or Y, got {', '.join(header.channels)}"
        )
    ((_, planes),) = parts(path, 1, separate_channels=names not in COLOURS)
    if names in COLOURS:
        E = next(iter(planes.values()))[..., :3]
    else:
        E = planes["Y" if "Y" in names else header.channels[0]]
    return _place(path, E.astype(np.float32, copy=False), header)


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
    sign, e, m = 1 - 2 * (bits >> 15), bits >> 10 & 31, bits & 1023
    value = np.where(e > 0, 1024 + m, 2 * m) * 2.0 ** (e - 25)
    value[e == 31] = np.where(m[e == 31] > 0, np.nan, np.inf)
    return (sign * value).astype(np.float32)


def read_dtypes(path: str | Path) -> tuple[str, ...]:
    """Return the name of each channel's dtype: float16, float32 or uint32."""
    header = read_header(path)
    ((_, planes),) = parts(path, 1, separate_channels=True)
    return tuple(planes[name].dtype.name for name in header.channels)


def write(
    path: str | Path, E: ArrayLike, *, half: bool = False, comments: Sequence[str] = ()
) -> None:
    """Write radiance as an OpenEXR file of float32, without loss, whole or not at all.

    Parameters
    ----------
    path : the file; what it held is replaced
    E : (H, W) or (H, W, 3) radiance, finite and not negative; one channel is written as Y
    half : True for 16-bit floats: half the size, 3 digits, up to 65504
    comments : sentences for the header's attribute `comments`

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
        raise FileFormatError(
            f"expected radiance up to {LARGEST_HALF:.0f} for half floats, got {E.max():.6g}"
        )
    pixels = np.ascontiguousarray(E, np.float16 if half else np.float32)
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    if comments:
        header["comments"] = "\n".join(comments)
    save(path, header, {"RGB" if E.ndim == 3 else "Y": pixels})


def save(path: str | Path, *content: Any) -> None:
    """Write a header and its channels, or a list of OpenEXR's parts, whole or not at all."""
    with replacing(path) as name, OpenEXR.File(*content) as file:
        try:
            file.write(str(name))
        except RuntimeError as error:
            raise OSError(errno.EIO, f"{error}: is the disk full?", str(path)) from None


def parts(
    path: str | Path,
    count: int | None = None,
    *,
    header_only: bool = False,
    separate_channels: bool = False,
) -> list[Part]:
    """Return the header, and the pixels by channel, of the first `count` parts of the file at `path`."""
    with open(path, "rb") as start:  # the module takes a missing file for one that is not OpenEXR
        magic = start.read(4)
    if magic != b"v/1\x01":
        raise FileFormatError(f"{path}: expected an OpenEXR file, got {magic!r}")
    # the module prints what is wrong with a part, and leaves the part out
    opened, which = (
        OpenEXR.File,
        (str(path), separate_channels, header_only),
    )  # that it lacks is no damage
    try:
        with (
            PRINTING,
            silence(2),
            redirect_stdout(printed := io.StringIO()),
            opened(*which) as file,
        ):
            found = []
            for part in file.parts[:count]:
                channels = [
                    (one.name, one.xSampling, one.ySampling) for one in part.header["channels"]
                ]
                planes = {name: channel.pixels for name, channel in part.channels.items()}
                found.append(({**part.header, "channels": channels}, planes))
            if printed.getvalue() or not found:  # it tells of parts that it leaves out
                raise FileFormatError("a part cannot be read")
            return found
    except (
        Exception
    ) as error:  # damaged files make it raise what they like, UnicodeDecodeError included
        reason = printed.getvalue().strip().rpartition(" - ")[2] or str(error)
        raise FileFormatError(
            f"{path}: expected an OpenEXR file, it is cut short or damaged ({reason})"
        ) from None


def _window(path: str | Path, window: tuple[Labels, Labels], channels: int) -> Window:
    """Return the Window of an attribute (left, top), (right, bottom), after a look at its size."""
    (left, top), (right, bottom) = (corner.tolist() for corner in window)
    height, width = bottom - top + 1, right - left + 1
    check_size(path, height, width, height * width * channels // BEST_COMPRESSION_RATIO)
    return Window(top, left, height, width)


def _place(path: str | Path, E: F32, header: Header) -> F32:
    """Return E, which fills the data window, on the display window."""
    data, display = header.data, header.display
    if E.shape[:2] != (data.height, data.width):
        raise FileFormatError(
            f"{path}: expected {data.height} x {data.width} pixels of data, got {E.shape[:2]}"
        )
    if data == display:
        return np.ascontiguousarray(E)
    top, left = data.top - display.top, data.left - display.left
    rows = slice(max(top, 0), min(top + data.height, display.height))
    columns = slice(max(left, 0), min(left + data.width, display.width))
    if rows.start >= rows.stop or columns.start >= columns.stop:
        raise FileFormatError(
            f"{path}: expected pixels in its display window {display}, they are all in {data}"
        )
    placed = np.zeros((display.height, display.width, *E.shape[2:]), np.float32)
    placed[rows, columns] = E[
        rows.start - top : rows.stop - top, columns.start - left : columns.stop - left
    ]
    return placed
