"""Radiance RGBE files, .hdr and .pic (Ward, Real Pixels, Graphics Gems II, 1991).

m   mantissas of red, green and blue   (H, W, 3), 0 to 255
e   the exponent that the three share   (H, W), 0 to 255
E   radiance                            (H, W, 3) float32, E = m / 256 * 2^(e - 128), and 0 where e = 0

Radiance itself decodes (m + 0.5) / 256, the middle of what a mantissa stands for; OpenCV, imageio
and most others decode m / 256, the lower end, and so does hdrlab: a file read and written again is
then unchanged. Run-length scanlines go through imagecodecs; the equations below serve the other
files, and say what it does.
"""

import re
from collections.abc import Sequence
from pathlib import Path
from textwrap import wrap
from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F32, F64, ArrayLike, NDArray, as_radiance
from hdrlab.core.optional import imagecodecs
from hdrlab.errors import FileFormatError
from hdrlab.io import decode, files

# the last line of the header, such as -Y 768 +X 512
RESOLUTION = re.compile(r"([-+])([XY]) +(\d{1,10}) +([-+])([XY]) +(\d{1,10})")
# 2^(e - 128) / 256, of each exponent e
SCALE = np.ldexp(1.0, np.arange(256) - 136).astype(np.float32)
SCALE[0] = 0
# how rows and columns run, in the order of EXIF's orientations
AXES = ("-Y+X", "-Y-X", "+Y-X", "+Y+X", "+X-Y", "-X-Y", "-X+Y", "+X+Y")
# pixels: the longest run that one code of two bytes stands for
LONGEST_RUN = 127
# letters of a comment: OpenCV reads lines of up to 127
COMMENT = 100
# rows: a band that is encoded at a time
BAND_ROWS = 64


class Header(NamedTuple):
    """What a Radiance file says before its pixels.

    Attributes
    ----------
    height, width : of the picture, upright
    axes : the resolution line's order and signs, such as "-Y+X": rows from the top, each from the
        left
    exposure : (3,) what the pixels were multiplied by: the product of all EXPOSURE and COLORCORR
        lines
    lines : the header's lines
    start : where the pixels begin, in bytes
    """

    height: int
    width: int
    axes: str
    exposure: F64
    lines: tuple[str, ...]
    start: int


def read(path: str | Path) -> F32:
    """Read a Radiance RGBE file: flat, old or new run-length scanlines, in any of the eight orientations.

    Parameters
    ----------
    path : the file

    Returns
    -------
    (H, W, 3) float32, radiance: the pixels' values divided by the header's exposures.

    Raises
    ------
    ValueError
        For a file that is not one, is cut short or damaged, or holds XYZE colours.

    References
    ----------
    Ward, G., "Real Pixels", Graphics Gems II, Academic Press 1991, 80-83.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "light.hdr"
    >>> write(file, [[[1.0, 0.5, 0.25]]])
    >>> read(file).tolist()
    [[[1.0, 0.5, 0.25]]]
    """
    header = read_header(path)
    scanlines, length = (header.height, header.width)[:: 1 if header.axes[1] == "Y" else -1]
    with open(path, "rb") as file:
        file.seek(header.start)
        data = file.read()
    if 8 <= length <= 32767 and b"\2\2\0" <= data[:3] < b"\2\2\x80" and len(data) > 3:
        E = _run_lengths(path, data, scanlines, length)
    else:
        files.check_size(path, scanlines, length, 4 * scanlines, available=len(data))
        E = to_radiance(_pixels(path, data, scanlines, length))
    E = np.ascontiguousarray(decode.upright(E, 1 + AXES.index(header.axes)))
    if np.any(header.exposure != 1):
        E /= header.exposure.astype(np.float32)
    return E


def write(path: str | Path, E: ArrayLike, *, comments: Sequence[str] = ()) -> None:
    """Write radiance as a Radiance RGBE file, whole or not at all.

    Parameters
    ----------
    path : the file; what it held is replaced
    E : (H, W) or (H, W, 3) radiance, finite and not negative; one channel is written as three equal
        ones
    comments : sentences for the header, in lines that begin with #

    Raises
    ------
    ValueError
        For NaN, infinite or negative values, and for values of 2^127 or more, which RGBE cannot
        hold.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "gray.hdr"
    >>> write(file, np.ones((4, 10)))
    >>> read(file).shape
    (4, 10, 3)
    """
    E = as_radiance(E)
    height, width = E.shape[:2]
    if E.max() >= 2.0**127:
        raise FileFormatError(
            f"expected radiance below 2^127 for RGBE, got values up to {E.max():.6g}"
        )
    E = np.broadcast_to(E if E.ndim == 3 else E[..., None], (height, width, 3))
    room = bytearray(
        BAND_ROWS * (4 + 4 * (width + width // 128 + 1))
    )  # for a band in which nothing repeats
    with files.replacing(path) as name, open(name, "wb") as file:
        said = "".join(f"# {line}\n" for one in comments for line in wrap(one, COMMENT))
        head = f"#?RADIANCE\n{said}FORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n"
        file.write(head.encode("ascii", "replace"))
        for y in range(0, height, BAND_ROWS):
            band = np.ascontiguousarray(E[y : y + BAND_ROWS])
            file.write(imagecodecs.rgbe_encode(band, header=False, rle=True, out=room))


def to_radiance(pixels: NDArray[np.uint8]) -> F32:
    """Return E = m / 256 2^(e - 128) of pixels (H, W, 4), three mantissas m and the exponent e [Ward91]."""
    return pixels[..., :3] * SCALE[pixels[..., 3:]]


def to_pixels(E: F32) -> NDArray[np.uint8]:
    """Return m = floor(256 E 2^(128 - e)) and e, so that the largest m is 128 or more [Ward91].

    Examples
    --------
    >>> to_pixels(np.array([[[1.0, 0.5, 0.25]]], np.float32)).tolist()
    [[[128, 64, 32, 129]]]
    """
    brightest = E.max(axis=-1, keepdims=True)
    _, exponent = np.frexp(brightest)
    mantissa = np.ldexp(E, 8 - exponent)
    pixels = np.concatenate([mantissa, exponent + 128], axis=-1)
    return np.where(brightest < 1e-32, 0, pixels).astype(np.uint8)  # Ward's limit: below it, black


def _run_lengths(path: str | Path, data: bytes, scanlines: int, length: int) -> F32:
    """Return E of run-length scanlines, each of which begins with 2, 2 and its length in two bytes."""
    if (stated := data[2] * 256 + data[3]) != length:
        raise FileFormatError(f"{path}: expected scanlines of {length} pixels, got one of {stated}")
    least = scanlines * (4 + 4 * 2 * -(-length // LONGEST_RUN))
    files.check_size(path, scanlines, length, least, available=len(data))
    E = np.empty((scanlines, length, 3), np.float32)
    try:
        return imagecodecs.rgbe_decode(data, header=False, rle=True, out=E)
    except (imagecodecs.RgbeError, ValueError):
        raise FileFormatError(
            f"{path}: expected {scanlines} scanlines, they are damaged or cut short"
        ) from None


def _pixels(path: str | Path, data: bytes, scanlines: int, length: int) -> NDArray[np.uint8]:
    """Return the pixels (H, W, 4) of flat scanlines, among which (1, 1, 1, n) repeats the pixel before it.

    Such marks in a row are the digits of one count in base 256, the lowest first: the oldest run
    lengths.
    """
    count = scanlines * length
    words = np.frombuffer(data, "<u4", min(len(data) // 4, count))
    marks, place = (words & 0xFFFFFF) == 0x010101, np.arange(len(words))
    pixel = np.maximum.accumulate(np.where(marks, -1, place))  # the last that is not a mark
    digit = np.clip(place - pixel - 1, 0, 4)
    counts = np.where(marks, (words >> 24).astype(np.int64) << 8 * digit, 1)
    made = np.cumsum(counts)
    last = int(np.searchsorted(made, count))
    if last == len(made) or made[last] != count or marks[0]:
        size = f"{scanlines} scanlines of {length} pixels"
        raise FileFormatError(f"{path}: expected {size}, they are damaged or cut short")
    repeated = words[pixel[: last + 1]].repeat(counts[: last + 1])
    return repeated.view(np.uint8).reshape(scanlines, length, 4)


def read_header(path: str | Path) -> Header:
    """Return the Header of the Radiance file at `path`, or raise a ValueError."""
    with open(path, "rb") as file:
        return parse(path, file.read(1 << 16))


def parse(path: str | Path, head: bytes) -> Header:
    """Return what the lines down to the resolution say, or raise a ValueError that names the file."""
    lines, start = [], 0
    while (end := head.find(b"\n", start)) >= 0:
        line, start = head[start:end].decode("latin-1"), end + 1
        if match := RESOLUTION.fullmatch(line.rstrip("\r")):
            break
        if line.strip():
            lines.append(line.rstrip())
    else:
        match = None
    # the mark need not come first: tools of Radiance put lines of their own before it
    if match is None or not any(line.startswith("#?") for line in lines):
        raise FileFormatError(
            f"{path}: expected a Radiance file (#?RADIANCE, -Y 768 +X 512), got {head[:16]!r}"
        )
    if line.endswith("\r"):
        raise FileFormatError(
            f"{path}: expected a binary file, its line ends became CR LF: copied as text"
        )
    values = dict(part.split("=", 1) for part in lines if "=" in part)
    if (form := values.get("FORMAT", "32-bit_rle_rgbe").strip()) != "32-bit_rle_rgbe":
        raise FileFormatError(f"{path}: expected FORMAT=32-bit_rle_rgbe, got {form[:60]!r}")
    sign, axis, first, sign2, axis2, second = match.groups()
    if axis == axis2:
        raise FileFormatError(
            f"{path}: expected one X and one Y in the resolution, got {line[:60]!r}"
        )
    height, width = (int(first), int(second))[:: 1 if axis == "Y" else -1]
    files.check_size(path, height, width)
    return Header(
        height, width, sign + axis + sign2 + axis2, _exposure(path, lines), tuple(lines), start
    )


def _exposure(path: str | Path, lines: list[str]) -> F64:
    """Return the product of the EXPOSURE and COLORCORR lines: each tool that changed the pixels adds one."""
    product = np.ones(3)
    for line in lines:
        name, _, value = line.partition("=")
        if name in ("EXPOSURE", "COLORCORR"):
            try:
                product = product * np.array(value.split(), dtype=np.float64)
            except ValueError:
                raise FileFormatError(
                    f"{path}: expected numbers in its header, got {line[:60]!r}"
                ) from None
    if not np.all((product > 1e-30) & (product < 1e30)):
        raise FileFormatError(
            f"{path}: expected positive exposures in its header, got {product.tolist()}"
        )
    return product
