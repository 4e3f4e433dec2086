"""One photograph, in two steps: look at its header, then decode its pixels straight into their place.

JPEG and PNG are decoded by imagecodecs, which keeps all 16 bits (Pillow cuts RGB to 8) and writes into an
array that is there; TIFF by tifffile; RAW by hdrlab.io.raw. Pillow reads EXIF.
"""

import io
import logging
import struct
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from PIL import ExifTags, Image

from hdrlab.core.optional import imagecodecs, tifffile
from hdrlab.core.types import Array
from hdrlab.io import raw
from hdrlab.io.exif_exposure import Exposure, exif_exposure
from hdrlab.io.files import check_size

for codec in ("tifffile", "imagecodecs"):  # our errors report what is wrong
    logging.getLogger(codec).addHandler(logging.NullHandler())

Exif = tuple[int, Exposure]  # the orientation and the exposure
Looks = tuple[str, tuple[int, ...], np.dtype[Any], Exif]  # kind, shape as it is stored, dtype

# bytes of a picture in one of the file: more than any of these formats reaches
BEST_COMPRESSION_RATIO = 1 << 12
MODES = {"1": "1-bit pixels", "P": "a palette", "PA": "a palette", "LAB": "Lab"}
MODES |= {"F": "floating point", "I": "32-bit integers"}
UPRIGHT: dict[int, Callable[[Array], Array]] = {  # the EXIF orientations
    1: lambda a: a,
    2: lambda a: a[:, ::-1],
    3: lambda a: a[::-1, ::-1],
    4: lambda a: a[::-1],
    5: lambda a: a.swapaxes(0, 1),
    6: lambda a: a.swapaxes(0, 1)[:, ::-1],
    7: lambda a: a.swapaxes(0, 1)[::-1, ::-1],
    8: lambda a: a.swapaxes(0, 1)[::-1],
}


class Header(NamedTuple):
    """What a photograph says before its pixels; `shape` is upright, (H, W) or (H, W, 3)."""

    path: Path
    kind: str
    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    orientation: int = 1
    exposure: Exposure = Exposure()


def look(path: str | Path) -> Header:
    """Return the Header of the photograph at `path`, or raise a ValueError for what is not one."""
    path = Path(path)
    if raw.is_raw(path):
        size, exposure = raw.look(path)
        return Header(path, "RAW", size, np.dtype(np.uint16), 1, exposure)
    with open(path, "rb") as file:
        head = file.read(32)
    if head[:4] in (b"II*\0", b"MM\0*"):
        kind, shape, dtype, exif = _look_tiff(path)
    elif head[:3] == b"\xff\xd8\xff" or head[:8] == b"\x89PNG\r\n\x1a\n":
        kind, shape, dtype, exif = _look_pillow(path, head)
    else:
        raise ValueError(f"{path}: expected a JPEG, PNG or TIFF photograph, got {head[:8]!r}")
    orientation, exposure = exif
    check_size(path, shape[0], shape[1], int(np.prod(shape)) * dtype.itemsize // BEST_COMPRESSION_RATIO)
    if orientation > 4:
        shape = (shape[1], shape[0], *shape[2:])
    return Header(path, kind, shape, dtype, orientation, exposure)


def decode(header: Header, out: Array, *, balance: raw.Balance | None = None) -> None:
    """Decode the photograph into `out`, of its upright shape; `balance` is a white balance for RAW."""
    if header.kind == "RAW":
        pixels = raw.decode(header.path, balance)
    else:
        stored = stored_pixels(header.path, header.kind, out if header.orientation == 1 else None)
        pixels = UPRIGHT[header.orientation](stored)
    if pixels.shape != out.shape or pixels.dtype != out.dtype:
        got = f"{pixels.shape} {pixels.dtype}"
        raise ValueError(f"{header.path}: expected {out.shape} {out.dtype}, got {got}")
    if pixels is not out:
        out[...] = pixels


def stored_pixels(path: Path, kind: str, out: Array | None = None) -> Array:
    """Return the pixels of a file of that kind as they are stored, or raise a ValueError if it is damaged."""
    data = path.read_bytes()
    try:
        return DECODERS[kind](data, out)
    except ModuleNotFoundError:  # no codec: the file may be good
        raise
    except Exception as error:  # on damaged files the codecs raise what they like
        why = str(error)[:200] or type(error).__name__
        raise ValueError(f"{path}: it is cut short or damaged ({why})") from None


def _jpeg(data: bytes, out: Array | None) -> Array:
    # libjpeg fills what is missing with gray and only warns; a marker cannot stand inside coded pixels
    if data.rfind(b"\xff\xd9") < data.rfind(b"\xff\xda"):
        raise ValueError("no end of image after its last scan")
    return imagecodecs.jpeg8_decode(data, out=out) if imagecodecs else _pillow(data)


def _png(data: bytes, out: Array | None) -> Array:
    return imagecodecs.png_decode(data, out=out) if imagecodecs or data[24] > 8 else _pillow(data)


def _pillow(data: bytes) -> Array:
    """Decode 8 bits a channel where imagecodecs is not installed."""
    with Image.open(io.BytesIO(data), formats=("JPEG", "PNG")) as image:
        return np.asarray(image)


def _tiff(data: bytes, out: Array | None) -> Array:
    with tifffile.TiffFile(io.BytesIO(data)) as file:
        page = file.pages.first
        ends = map(sum, zip(page.dataoffsets, page.databytecounts, strict=True))
        if max(ends, default=0) > len(data) or np.prod(page.chunks) > max(4 * np.prod(page.shape), 1 << 24):
            raise ValueError("its pixels go past the end of the file, or its tiles far beyond its picture")
        pixels = page.asarray()
    if page.planarconfig == tifffile.PLANARCONFIG.SEPARATE and pixels.ndim == 3:
        pixels = np.moveaxis(pixels, 0, -1)
    return pixels.astype(pixels.dtype.newbyteorder("="), copy=False)


DECODERS = {"JPEG": _jpeg, "PNG": _png, "TIFF": _tiff}


def _look_pillow(path: Path, head: bytes) -> Looks:
    """Return what is stated by the header of a JPEG or PNG file."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of sizes, which check_size judges, and of odd EXIF
            with Image.open(path, formats=("JPEG", "PNG")) as image:
                kind, (width, height), mode, info = image.format, image.size, image.mode, dict(image.info)
    except Image.DecompressionBombError as error:
        raise ValueError(f"{path}: its header claims an absurd size ({error})") from None
    except Exception as error:  # on damaged files Pillow raises what it likes
        raise ValueError(f"{path}: expected a photograph, its header is damaged ({error})") from None
    depth = struct.unpack_from(">B", head, 24)[0] if kind == "PNG" else 8
    if mode.endswith("A") or "transparency" in info:
        mode = "an alpha channel"
    if depth not in (8, 16) or mode not in ("L", "RGB", "I;16"):
        what = MODES.get(mode, mode) if depth in (8, 16) else f"{depth}-bit pixels"
        raise ValueError(f"{path}: expected gray or RGB of 8 or 16 bits, got {what}")
    shape = (height, width) if mode != "RGB" else (height, width, 3)
    exif = _exif(lambda exif: exif.load(info.get("exif", b"")))
    return "PNG" if kind == "PNG" else "JPEG", shape, np.dtype(f"u{depth // 8}"), exif


class TiffPage(NamedTuple):
    """What the first page of a TIFF file says of its pixels; `alpha` of the `channels` are no colours."""

    height: int
    width: int
    depth: int
    channels: int
    alpha: int
    dtype: np.dtype[Any]
    kind: str
    description: str


def tiff_page(path: str | Path) -> TiffPage:
    """Return the TiffPage of the file at `path`, or raise a ValueError."""
    open_tiff = tifffile.TiffFile
    try:
        with open_tiff(path) as file:
            page = file.pages.first
            kind = str(getattr(page.photometric, "name", page.photometric))[:40]
            size = int(page.imagelength), int(page.imagewidth), int(page.imagedepth)
            channels = int(page.samplesperpixel), len(page.extrasamples)
            return TiffPage(*size, *channels, np.dtype(page.dtype), kind, page.description)
    except Exception as error:  # on damaged files tifffile raises what it likes
        raise ValueError(
            f"{path}: expected a photograph, its header is damaged ({str(error)[:200]})"
        ) from None


def _look_tiff(path: Path) -> Looks:
    """Return what is stated by the first page of a TIFF file."""
    page = tiff_page(path)
    kind = "an alpha channel" if page.alpha else page.kind
    if (kind, page.channels) not in (("MINISBLACK", 1), ("RGB", 3)) or page.dtype not in ("u1", "u2"):
        what = f"{page.channels} x {page.dtype}, {kind}"
        raise ValueError(f"{path}: expected gray or RGB of 8 or 16 bits, got {what}")
    if page.depth != 1:
        raise ValueError(f"{path}: expected one picture, got {page.depth} on one another")
    with open(path, "rb") as stream:
        exif = _exif(lambda exif: exif.load_from_fp(stream))
    return "TIFF", (page.height, page.width, 3)[: 2 + (page.channels == 3)], page.dtype, exif


def _exif(load: Callable[[Image.Exif], None]) -> Exif:
    """Return orientation and Exposure; EXIF that cannot be read says nothing, the photograph may be good."""
    exif = Image.Exif()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            load(exif)
            orientation, exposure = exif.get(ExifTags.Base.Orientation, 1), exif_exposure(exif)
    except Exception:
        return 1, Exposure()
    return (orientation if orientation in UPRIGHT else 1), exposure
