"""Radiance RGBE files, .hdr and .pic (Ward, Real Pixels, Graphics Gems II, 1991).

m   mantissas of red, green and blue   (H, W, 3), 0 to 255
e   the exponent that the three share   (H, W), 0 to 255
E   radiance                            (H, W, 3) float32, E = m / 256 * 2^(e - 128), and 0 where e = 0

Radiance itself decodes (m + 0.5) / 256, the middle of what a mantissa stands for; OpenCV, imageio
and most others decode m / 256, the lower end, and so does hdrlab: numbers that fit into the
mantissa, such as 1, are then exact. imagecodecs codes run-length scanlines quickly; without it, and
for the other files, the equations below do.

Values of E have the primaries of the header's PRIMARIES line. Without one, Radiance means
`RADIANCE_PRIMARIES`, but most other programs, and hdrlab, take those of sRGB.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from textwrap import wrap

import numpy as np

from hdrlab.core.arrays import F32, F64, ArrayLike, NDArray, as_radiance
from hdrlab.core.optional import imagecodecs
from hdrlab.errors import FileFormatError, InputError
from hdrlab.io import decode, files

# the last line of the header, such as -Y 768 +X 512
RESOLUTION = re.compile(r"([-+])([XY]) +(\d{1,10}) +([-+])([XY]) +(\d{1,10})")
# 2^(e - 128) / 256, of each exponent e
SCALE = np.ldexp(1.0, np.arange(256) - 136).astype(np.float32)
SCALE[0] = 0
# How rows and columns run, in the order of EXIF's orientations.
AXES = ("-Y+X", "-Y-X", "+Y-X", "+Y+X", "+X-Y", "-X-Y", "-X+Y", "+X+Y")
FORMAT = "32-bit_rle_rgbe"
MAX_RADIANCE = 2.0**127
MAX_HEADER_BYTES = 2**16
# Two bytes code a run of at most this many pixels.
MAX_RUN_PIXELS = 127
# A count of at most this many bytes precedes bytes that do not repeat.
MAX_LITERAL_PIXELS = 128
# Two bytes code a run, so that shorter ones gain little.
MIN_RUN_PIXELS = 4
# Lengths of scanlines that can be run-length coded.
MIN_RUN_LENGTH_SCANLINE = 8
MAX_RUN_LENGTH_SCANLINE = 32767
# OpenCV reads header lines of up to 127 characters.
MAX_COMMENT_CHARACTERS = 100
# Rows that are encoded at a time.
BAND_ROWS = 64
# Pixels of which a flat file stores a repetition count have this value, without the exponent.
REPEAT_MARK = 0x010101
# x and y of red, green, blue and white, if no line states them [Radiance, common/color.h].
RADIANCE_PRIMARIES = (0.64, 0.33, 0.29, 0.60, 0.15, 0.06, 1 / 3, 1 / 3)
PRIMARIES_TOLERANCE = 1e-3
MIN_EXPOSURE = 1e-30
MAX_EXPOSURE = 1e30


@dataclass(frozen=True)
class Header:
    """What a Radiance file states before its pixels.

    Attributes
    ----------
    height, width
        Of the upright image.
    axes
        Order and signs of the resolution line. "-Y+X" means rows from the top, each from the left.
    exposure
        (3,) what the pixels were multiplied by: the product of all EXPOSURE and COLORCORR lines.
    primaries
        x and y of red, green, blue and white by the last PRIMARIES line, or None without such a
        line, and if it states what Radiance takes without one.
    lines
        The lines of the header.
    start
        The offset of the pixels, in bytes.
    """

    height: int
    width: int
    axes: str
    exposure: F64
    primaries: tuple[float, ...] | None
    lines: tuple[str, ...]
    start: int


def read(path: str | Path) -> F32:
    """Read a Radiance RGBE file, in any of the eight orientations.

    Scanlines may be flat, or coded by the old or the new kind of run lengths, each in its own way.

    Parameters
    ----------
    path : the file

    Returns
    -------
    (H, W, 3) float32, radiance: the pixels' values divided by the header's exposures. They have the
    primaries that the header states; `io.radiance.read_radiance` converts them to sRGB.

    Raises
    ------
    ValueError
        For a file that is not one, is cut short or damaged, or holds XYZE colors.

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
    scanlines = header.height
    length = header.width
    if header.axes[1] == "X":
        scanlines, length = length, scanlines
    with open(path, "rb") as file:
        file.seek(header.start)
        data = file.read()
    has_run_lengths = _has_run_length_scanlines(data, length)
    is_slow = has_run_lengths and not imagecodecs.has_codec("RGBE")
    if is_slow or _has_mixed_scanlines(data, scanlines, length):
        E = to_radiance(_decode_mixed_scanlines(path, data, scanlines, length))
    elif has_run_lengths:
        E = _decode_run_lengths(path, data, scanlines, length)
    else:
        files.check_size(path, scanlines, length, 4 * scanlines, available=len(data))
        E = to_radiance(_decode_flat_pixels(path, data, scanlines, length))
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
    if E.max() >= MAX_RADIANCE:
        raise InputError(f"expected radiance below 2^127 for RGBE, got values up to {E.max():.6g}")
    E = np.broadcast_to(E if E.ndim == 3 else E[..., None], (height, width, 3))
    header = "#?RADIANCE\n"
    for comment in comments:
        for line in wrap(comment, MAX_COMMENT_CHARACTERS):
            header += f"# {line}\n"
    header += f"FORMAT={FORMAT}\n\n-Y {height} +X {width}\n"
    is_fast = imagecodecs.has_codec("RGBE")
    # Enough for a band in which no pixel is repeated.
    buffer = bytearray(BAND_ROWS * (4 + 4 * (width + width // 128 + 1)))
    with files.replacing(path) as name, open(name, "wb") as file:
        file.write(header.encode("ascii", "replace"))
        for y in range(0, height, BAND_ROWS):
            band = np.ascontiguousarray(E[y : y + BAND_ROWS])
            if is_fast:
                file.write(imagecodecs.rgbe_encode(band, header=False, rle=True, out=buffer))
            else:
                file.write(b"".join(_encode_scanline(row) for row in to_pixels(band)))


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


def _run_length_mark(length: int) -> bytes:
    """Return what a run-length scanline begins with: 2, 2 and its length in two bytes."""
    return b"\2\2" + length.to_bytes(2, "big")


def _has_mixed_scanlines(data: bytes, scanlines: int, length: int) -> bool:
    """Return whether some scanlines may have run lengths, and others not.

    In a file of run-length scanlines alone, each has its mark. More marks may be pixels, so that
    True is only a possibility.
    """
    if not MIN_RUN_LENGTH_SCANLINE <= length <= MAX_RUN_LENGTH_SCANLINE:
        return False
    marks = data.count(_run_length_mark(length))
    begins_with_mark = data.startswith(_run_length_mark(length))
    return marks != (scanlines if begins_with_mark else 0)


def _decode_mixed_scanlines(
    path: str | Path, data: bytes, scanlines: int, length: int
) -> NDArray[np.uint8]:
    """Return the pixels (H, W, 4) of scanlines of which each is flat or has run lengths."""
    mark = _run_length_mark(length)
    # A flat scanline of one color takes a pixel and a mark that repeats it.
    files.check_size(path, scanlines, length, 8 * scanlines, available=len(data))
    rows: list[NDArray[np.uint8]] = []
    start = 0
    try:
        for _ in range(scanlines):
            if data.startswith(mark, start):
                row, start = _decode_run_length_scanline(data, start + len(mark), length)
            else:
                row, start = _decode_flat_scanline(data, start, length)
            rows.append(row)
    except (IndexError, ValueError):
        raise FileFormatError(
            f"{path}: scanline {len(rows) + 1} of {scanlines} is damaged or cut short"
        ) from None
    return np.stack(rows)


def _decode_run_length_scanline(
    data: bytes, start: int, length: int
) -> tuple[NDArray[np.uint8], int]:
    """Return the pixels (W, 4) of a run-length scanline behind its mark, and where the next starts.

    Red, green, blue and exponents follow each other. A count above 128 is a run of count - 128
    times the next byte, another count is that of the bytes that follow.
    """
    channels = bytearray()
    while len(channels) < 4 * length:
        count = data[start]
        if count > 128:
            run = data[start + 1 : start + 2] * (count - 128)
            start += 2
        else:
            run = data[start + 1 : start + 1 + count]
            start += 1 + count
        end_of_channel = (len(channels) // length + 1) * length
        if not run or len(channels) + len(run) > end_of_channel:
            raise ValueError("a run is empty or goes past its channel")
        channels += run
    pixels = np.frombuffer(bytes(channels), np.uint8).reshape(4, length)
    return pixels.T, start


def _encode_scanline(row: NDArray[np.uint8]) -> bytes:
    """Return a scanline (W, 4) with run lengths; flat if it is too short or too long for them.

    >>> _encode_scanline(np.full((9, 4), 7, np.uint8)).hex(" ")
    '02 02 00 09 89 07 89 07 89 07 89 07'
    """
    length = len(row)
    if not MIN_RUN_LENGTH_SCANLINE <= length <= MAX_RUN_LENGTH_SCANLINE:
        return row.tobytes()
    channels = [_encode_runs(channel.tobytes()) for channel in row.T]
    return _run_length_mark(length) + b"".join(channels)


def _encode_runs(values: bytes) -> bytes:
    """Return one channel of a scanline as runs and as bytes that do not repeat.

    >>> _encode_runs(bytes([1, 2, 3, 5, 5, 5, 5, 5])).hex(" ")
    '03 01 02 03 85 05'
    """
    array = np.frombuffer(values, np.uint8)
    changes = np.flatnonzero(np.diff(array)) + 1
    starts = np.concatenate([[0], changes])
    counts = np.diff(starts, append=len(array))
    is_run = counts >= MIN_RUN_PIXELS
    coded = bytearray()
    literal_start = 0
    run_starts = [*starts[is_run].tolist(), len(array)]
    run_counts = [*counts[is_run].tolist(), 0]
    for start, count in zip(run_starts, run_counts, strict=True):
        for first in range(literal_start, start, MAX_LITERAL_PIXELS):
            literal = values[first : min(first + MAX_LITERAL_PIXELS, start)]
            coded += bytes([len(literal)]) + literal
        literal_start = start + count
        for left in range(count, 0, -MAX_RUN_PIXELS):
            coded += bytes([128 + min(left, MAX_RUN_PIXELS), values[start]])
    return bytes(coded)


def _decode_flat_scanline(data: bytes, start: int, length: int) -> tuple[NDArray[np.uint8], int]:
    """Return the pixels (W, 4) of a flat scanline, and where the next one starts."""
    words = np.frombuffer(data, "<u4", min((len(data) - start) // 4, length), start)
    is_mark = (words & 0xFFFFFF) == REPEAT_MARK
    if is_mark.any():
        counts = _count_repetitions(words, is_mark)
        totals = np.cumsum(counts)
        last = int(np.searchsorted(totals, length))
        if is_mark[0] or totals[last] != length:
            raise ValueError("repetitions do not fill the scanline")
        words = words[_last_pixels(is_mark)[: last + 1]].repeat(counts[: last + 1])
        start += 4 * (last + 1)
    else:
        start += 4 * length
    if len(words) != length:
        raise ValueError("the scanline is cut short")
    return words.view(np.uint8).reshape(length, 4), start


def _last_pixels(is_mark: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Return for each word the place of the last one that is no mark of repetition, -1 for none."""
    return np.maximum.accumulate(np.where(is_mark, -1, np.arange(len(is_mark))))


def _count_repetitions(words: NDArray[np.uint32], is_mark: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Return how many pixels each word stands for: 1, or the digit of a mark times a power of 256."""
    digit = np.clip(np.arange(len(words)) - _last_pixels(is_mark) - 1, 0, 4)
    return np.where(is_mark, (words >> 24).astype(np.int64) << 8 * digit, 1)


def _has_run_length_scanlines(data: bytes, length: int) -> bool:
    """Return whether the first scanline begins with 2, 2 and its length in two bytes."""
    is_possible = MIN_RUN_LENGTH_SCANLINE <= length <= MAX_RUN_LENGTH_SCANLINE
    return is_possible and len(data) > 3 and data[:2] == b"\2\2" and data[2] < 0x80


def _decode_run_lengths(path: str | Path, data: bytes, scanlines: int, length: int) -> F32:
    """Return E of run-length scanlines."""
    stated_length = data[2] * 256 + data[3]
    if stated_length != length:
        raise FileFormatError(
            f"{path}: expected scanlines of {length} pixels, got one of {stated_length}"
        )
    runs_per_channel = -(-length // MAX_RUN_PIXELS)
    min_bytes = scanlines * (4 + 4 * 2 * runs_per_channel)
    files.check_size(path, scanlines, length, min_bytes, available=len(data))
    E = np.empty((scanlines, length, 3), np.float32)
    try:
        return imagecodecs.rgbe_decode(data, header=False, rle=True, out=E)
    except (imagecodecs.RgbeError, ValueError):
        raise FileFormatError(
            f"{path}: the {scanlines} scanlines are damaged or cut short"
        ) from None


def _decode_flat_pixels(
    path: str | Path, data: bytes, scanlines: int, length: int
) -> NDArray[np.uint8]:
    """Return the pixels (H, W, 4) of flat scanlines, in which (1, 1, 1, n) repeats the pixel before.

    Several such marks in a row are the digits of one count in base 256, the lowest first. This is
    the oldest kind of run lengths.
    """
    count = scanlines * length
    words = np.frombuffer(data, "<u4", min(len(data) // 4, count))
    is_mark = (words & 0xFFFFFF) == REPEAT_MARK
    counts = _count_repetitions(words, is_mark)
    totals = np.cumsum(counts)
    last = int(np.searchsorted(totals, count))
    if last == len(totals) or totals[last] != count or is_mark[0]:
        size = f"{scanlines} scanlines of {length} pixels"
        raise FileFormatError(f"{path}: the {size} are damaged or cut short")
    repeated = words[_last_pixels(is_mark)[: last + 1]].repeat(counts[: last + 1])
    return repeated.view(np.uint8).reshape(scanlines, length, 4)


def read_header(path: str | Path) -> Header:
    """Return the header of a Radiance file, or raise a FileFormatError."""
    with open(path, "rb") as file:
        return parse_header(path, file.read(MAX_HEADER_BYTES))


def parse_header(path: str | Path, head: bytes) -> Header:
    """Return what the lines down to the resolution state.

    Raises
    ------
    FileFormatError
        Naming the file, if it is not a Radiance file or its header is damaged.
    """
    lines, resolution, start = _split_header(head)
    match = RESOLUTION.fullmatch(resolution.rstrip("\r"))
    # "#?" need not come first: tools of Radiance put lines of their own before it.
    if match is None or not any(line.startswith("#?") for line in lines):
        raise FileFormatError(
            f"{path}: expected a Radiance file (#?RADIANCE, -Y 768 +X 512), got {head[:16]!r}"
        )
    if resolution.endswith("\r"):
        raise FileFormatError(
            f"{path}: its line ends are CR LF, so a program copied it as text; "
            "copy the original again, as a binary file"
        )
    values = dict(line.split("=", 1) for line in lines if "=" in line)
    pixel_format = values.get("FORMAT", FORMAT).strip()
    if pixel_format != FORMAT:
        raise FileFormatError(f"{path}: expected FORMAT={FORMAT}, got {pixel_format[:60]!r}")
    sign, axis, scanlines, second_sign, second_axis, length = match.groups()
    if axis == second_axis:
        raise FileFormatError(
            f"{path}: expected one X and one Y in the resolution, got {resolution[:60]!r}"
        )
    height = int(scanlines)
    width = int(length)
    if axis == "X":
        height, width = width, height
    files.check_size(path, height, width)
    return Header(
        height=height,
        width=width,
        axes=sign + axis + second_sign + second_axis,
        exposure=_parse_exposure(path, lines),
        primaries=_parse_primaries(path, lines),
        lines=tuple(lines),
        start=start,
    )


def _split_header(head: bytes) -> tuple[list[str], str, int]:
    """Return the lines of the header, the resolution line or "", and the offset of the pixels."""
    lines: list[str] = []
    start = 0
    while True:
        end = head.find(b"\n", start)
        if end < 0:
            return lines, "", start
        line = head[start:end].decode("latin-1")
        start = end + 1
        if RESOLUTION.fullmatch(line.rstrip("\r")):
            return lines, line, start
        if line.strip():
            lines.append(line.rstrip())


def _parse_exposure(path: str | Path, lines: list[str]) -> F64:
    """Return the product of the EXPOSURE and COLORCORR lines, of which every tool adds one."""
    product = np.ones(3)
    for line in lines:
        name, _, value = line.partition("=")
        if name not in ("EXPOSURE", "COLORCORR"):
            continue
        try:
            product = product * np.array(value.split(), dtype=np.float64)
        except ValueError:
            raise FileFormatError(
                f"{path}: expected numbers in its header, got {line[:60]!r}"
            ) from None
    if not np.all((product > MIN_EXPOSURE) & (product < MAX_EXPOSURE)):
        raise FileFormatError(
            f"{path}: expected positive exposures in its header, got {product.tolist()}"
        )
    return product


def _parse_primaries(path: str | Path, lines: list[str]) -> tuple[float, ...] | None:
    """Return x and y of red, green, blue and white by the last PRIMARIES line, see `Header`."""
    stated = [line for line in lines if line.partition("=")[0] == "PRIMARIES"]
    if not stated:
        return None
    line = stated[-1]
    try:
        primaries = np.array(line.partition("=")[2].split(), dtype=np.float64).reshape(8)
    except ValueError:
        raise FileFormatError(
            f"{path}: expected x and y of red, green, blue and white, got {line[:90]!r}"
        ) from None
    if not primaries.any():
        return None  # some programs write zeros for primaries that they do not know
    if np.allclose(primaries, RADIANCE_PRIMARIES, rtol=0, atol=PRIMARIES_TOLERANCE):
        return None
    return tuple(map(float, primaries))
