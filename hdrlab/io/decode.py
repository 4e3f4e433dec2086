"""Read one photo in two steps: its header, then its pixels, straight into their place in an array.

The first bytes of a file tell its format, not its suffix. Only RAW files are known by their suffix,
because most of them begin like TIFF. `hdrlab.io.codecs` decodes the pixels, `hdrlab.io.raw` those of
RAW files, and Pillow reads EXIF. Colors of another space than sRGB are converted by their ICC
profile, see `hdrlab.io.profiles`.
"""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import Any, BinaryIO, Literal

import numpy as np
import PIL
from PIL import ExifTags, Image

from hdrlab.core import optional
from hdrlab.core.arrays import Array
from hdrlab.core.optional import pillow_heif
from hdrlab.core.silence import ignore_library_warnings
from hdrlab.errors import FileFormatError, InputError
from hdrlab.io import codecs, jpegxl, profiles, raw, tiff_pages
from hdrlab.io.exif_camera import read_camera, read_time_taken
from hdrlab.io.exif_exposure import Exposure, read_exposure
from hdrlab.io.files import CMYK_REASON, OtherPixels, check_size, require_no_folder

# What the files of each format begin with.
MAGIC = {
    "TIFF": rb"II[*+]\0|MM\0[*+]",
    "JPEG": rb"\xff\xd8\xff",
    "PNG": rb"\x89PNG\r\n\x1a\n",
    "WEBP": rb"RIFF....WEBP",
    "AVIF": rb"....ftyp.*avi[fs]",
    "HEIF": rb"....ftyp(he[iv]|mif1|msf1)",
    "JXL": rb"\xff\n|\0\0\0\x0cJXL \r\n\x87\n",
}
MAGIC_BYTES = 32
HEADER_BYTES = 2**18

# Bytes of pixels for one byte of the file: no file of these formats reaches more.
BEST_COMPRESSION_RATIO = 2**12
# A black photo takes hardly a kilobyte in the newer formats.
BEST_COMPRESSION_RATIOS = {"WEBP": 2**16, "AVIF": 2**16, "HEIF": 2**16, "JXL": 2**16}

PNG_BIT_DEPTH_OFFSET = 24
PNG_COLOR_TYPE_OFFSET = 25
PNG_COLOR_FLAG = 2

# Pillow's modes that hdrlab reads, and words for others.
READ_MODES = ("L", "LA", "RGB", "RGBA", "I;16")
MODE_NAMES = {
    "1": "1-bit pixels",
    "P": "a palette",
    "PA": "a palette",
    "LAB": "Lab",
    "F": "floating point",
    "I": "32-bit integers",
}

# Words near the beginning of a file with a gain map: Adobe's, those of ISO 21496-1, and Apple's.
GAIN_MAP_WORDS = (b"hdrgm:", b"urn:iso:std:iso:ts:21496", b"aux:hdrgainmap")
# PQ or HLG as a PNG, or AVIF and HEIC, state it: the transfer function behind the primaries.
PQ_OR_HLG = re.compile(rb"cICP.[\x10\x12]|nclx\0.\0[\x10\x12]", re.DOTALL)
# EXIF's CustomRendered for HDR, without and with the original, and for portraits and panoramas of
# HDR, as Apple writes them.
CUSTOM_RENDERED_HDR = (2, 3, 6, 7)
# EXIF's interoperability index of Adobe RGB [DCF 2.0].
INTEROP_INDEX_TAG = 1
INTEROP_ADOBE_RGB = "R03"

# Why a photo cannot be a frame of a bracket.
HAS_GAIN_MAP = "has a gain map: the picture in it was tone-mapped locally"
IS_PQ_OR_HLG = "is coded for an HDR screen, by PQ or HLG"
IS_BLENDED = "was put together by the camera out of several exposures"

Samples = Literal["integer", "floating", "any"]


@dataclass(frozen=True)
class PhotoHeader:
    """What a photo states before its pixels.

    Attributes
    ----------
    path
        The file.
    kind
        Its format, a key of `MAGIC` or "RAW".
    shape
        The upright shape, (H, W) or (H, W, 3).
    dtype
        The type of the stored samples.
    orientation
        EXIF's orientation, 1 to 8.
    exposure
        Seconds, f-number and ISO.
    icc
        The profile of its colors, empty for sRGB.
    processing
        Why the photo cannot be a frame of a bracket, empty if it can.
    comments
        The lines of a TIFF's description.
    camera
        The camera's name, empty if unknown.
    taken
        When the photo was taken, by the camera's clock, or None.
    """

    path: Path
    kind: str
    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    orientation: int = 1
    exposure: Exposure = Exposure()
    icc: bytes = b""
    processing: str = ""
    comments: Sequence[str] = ()
    camera: str = ""
    taken: datetime | None = None


@dataclass(frozen=True)
class ExifFacts:
    """What hdrlab uses of EXIF."""

    orientation: int = 1
    exposure: Exposure = Exposure()
    is_adobe_rgb: bool = False
    is_blended: bool = False
    camera: str = ""
    taken: datetime | None = None

    def icc(self, stored: bytes | None) -> bytes:
        """Return the profile of a file, or that of the space which EXIF names."""
        if stored:
            return stored
        return profiles.ADOBE if self.is_adobe_rgb else b""

    @property
    def processing(self) -> str:
        """Why the photo cannot be a frame of a bracket."""
        return IS_BLENDED if self.is_blended else ""


def read_header(path: str | Path, *, samples: Samples = "integer") -> PhotoHeader:
    """Return what the photo at `path` states before its pixels.

    Parameters
    ----------
    path
        The file.
    samples
        Whether its samples have to be integers, as in a photo, floating-point numbers, as in a
        radiance map, or any.

    Raises
    ------
    FileFormatError
        For a file that is no photo, or is damaged.
    OtherPixels
        For an image with other pixels than gray or RGB.
    """
    path = Path(path)
    require_no_folder(path, "a photo")
    if path.suffix.lower() in raw.SUFFIXES:
        raw_shape, exposure = raw.read_shape_and_exposure(path)
        with open(path, "rb") as stream:
            facts = _read_exif(partial(_load_tiff_exif, stream))
        return PhotoHeader(
            path,
            "RAW",
            raw_shape,
            np.dtype(np.uint16),
            exposure=exposure.fill_from(facts.exposure),
            camera=facts.camera,
            taken=facts.taken,
        )
    with open(path, "rb") as file:
        head = file.read(HEADER_BYTES)
    kind = _identify_format(path, head)
    if kind == "TIFF":
        header = _read_tiff_header(path)
    elif kind == "JXL":
        header = _read_jxl_header(path, head)
    else:
        header = _read_pillow_header(path, kind, head)
    _check_header_size(header)
    _require_samples(header, samples)
    shape = header.shape
    if header.orientation > 4:
        shape = (shape[1], shape[0], *shape[2:])
    return replace(header, shape=shape, processing=_find_processing(header, head))


def decode_photo(header: PhotoHeader, out: Array, *, balance: raw.Balance | None = None) -> None:
    """Decode a photo into `out`, an array of its upright shape.

    Parameters
    ----------
    header
        What `read_header` returned.
    out
        The array for the pixels, of `header.shape` and `header.dtype`.
    balance
        The white balance for a RAW file, by default its own.

    Raises
    ------
    FileFormatError
        For a damaged file.
    InputError
        For transparent pixels.
    """
    if header.kind == "RAW":
        pixels = raw.decode(header.path, balance)
    else:
        destination = out if header.orientation == 1 else None
        stored = codecs.decode_stored_pixels(header.path, header.kind, destination)
        pixels = upright(drop_alpha(header.path, stored), header.orientation)
        if header.icc and pixels.dtype.kind == "u":
            pixels = profiles.to_srgb(header.path, pixels, header.icc)
    if pixels.shape != out.shape or pixels.dtype != out.dtype:
        raise FileFormatError(
            f"{header.path}: expected {out.shape} {out.dtype}, got {pixels.shape} {pixels.dtype}"
        )
    if pixels is not out:
        out[...] = pixels


def upright(pixels: Array, orientation: int) -> Array:
    """Return stored pixels as they are to be seen, by EXIF's orientation."""
    if orientation == 1:
        return pixels
    if orientation > 4:
        pixels = pixels.swapaxes(0, 1)
    vertical_step = -1 if orientation in (3, 4, 7, 8) else 1
    horizontal_step = -1 if orientation in (2, 3, 6, 7) else 1
    return pixels[::vertical_step, ::horizontal_step]


def drop_alpha(path: Path, pixels: Array) -> Array:
    """Return pixels without their alpha channel.

    Raises
    ------
    InputError
        For integer pixels that are transparent.
    """
    if pixels.ndim < 3 or pixels.shape[2] == 3:
        return pixels
    if pixels.dtype.kind == "u" and (pixels[..., -1] != np.iinfo(pixels.dtype).max).any():
        raise InputError(
            f"{path}: expected gray or RGB, got an alpha channel with transparent pixels"
        )
    return pixels[..., 0] if pixels.shape[2] < 3 else pixels[..., :3]


def _identify_format(path: Path, head: bytes) -> str:
    for kind, magic in MAGIC.items():
        if re.match(magic, head[:MAGIC_BYTES], re.DOTALL):
            return kind
    raise FileFormatError(f"{path}: expected a photograph ({', '.join(MAGIC)}), got {head[:8]!r}")


def _check_header_size(header: PhotoHeader) -> None:
    """Raise FileFormatError if the file is too short for the pixels that its header claims."""
    ratio = BEST_COMPRESSION_RATIOS.get(header.kind, BEST_COMPRESSION_RATIO)
    min_bytes = int(np.prod(header.shape)) * header.dtype.itemsize // ratio
    check_size(header.path, header.shape[0], header.shape[1], min_bytes)


def _require_samples(header: PhotoHeader, samples: Samples) -> None:
    """Raise OtherPixels for integers where floating-point samples are needed, and vice versa."""
    is_floating = header.dtype.kind == "f"
    if samples == "any" or is_floating == (samples == "floating"):
        return
    wanted = "floating-point samples" if samples == "floating" else "8 or 16 bits"
    channels = header.shape[2] if len(header.shape) == 3 else 1
    pixels = f"{channels} x {header.dtype}, {tiff_pages.PHOTOMETRIC[channels]}"
    raise OtherPixels(f"{header.path}: expected gray or RGB of {wanted}, got {pixels}")


def _find_processing(header: PhotoHeader, head: bytes) -> str:
    """Return why a photo cannot be a frame of a bracket, or nothing."""
    if PQ_OR_HLG.search(head):
        return IS_PQ_OR_HLG
    if any(word in head for word in GAIN_MAP_WORDS):
        return HAS_GAIN_MAP
    return header.processing


def _read_pillow_header(path: Path, kind: str, head: bytes) -> PhotoHeader:
    """Return the header of a format that Pillow opens."""
    if kind == "HEIF":
        pillow_heif.register_heif_opener()
    if kind == "AVIF":
        _require_avif(path)
    try:
        # Pillow warns of large sizes, which check_size judges, and of odd EXIF.
        with ignore_library_warnings(), Image.open(path, formats=(kind,)) as image:
            width, height = image.size
            mode = image.mode
            info = dict(image.info)
        depth = info.get("bit_depth", _read_bit_depth(kind, head))
    except Image.DecompressionBombError as error:
        raise FileFormatError(f"{path}: its header claims too large a size ({error})") from None
    except Exception as error:  # on damaged files Pillow raises exceptions of any type
        raise FileFormatError(
            f"{path}: expected a photograph, its header is damaged ({error})"
        ) from None
    _require_readable_mode(path, "an alpha channel" if "transparency" in info else mode, depth)
    is_color = mode.startswith("RGB")
    if kind == "PNG":  # Pillow turns gray of 16 bits with alpha into RGBA
        is_color = bool(head[PNG_COLOR_TYPE_OFFSET] & PNG_COLOR_FLAG)
    facts = _read_exif(lambda: _load_exif(info.get("exif")))
    return PhotoHeader(
        path,
        kind,
        shape=(height, width, 3) if is_color else (height, width),
        dtype=np.dtype(np.uint8 if depth == 8 else np.uint16),
        orientation=facts.orientation,
        exposure=facts.exposure,
        icc=facts.icc(info.get("icc_profile")),
        processing=facts.processing,
        camera=facts.camera,
        taken=facts.taken,
    )


def _require_avif(path: Path) -> None:
    """Raise MissingPackageError if Pillow itself does not read AVIF.

    pillow-heif before 1.0 registers a reader of its own, which turns images by EXIF.
    """
    Image.init()
    if "AVIF" not in Image.OPEN or not hasattr(PIL, "AvifImagePlugin"):
        raise optional.MissingPackageError(
            f"{path}: AVIF needs Pillow 11.3 or later, this is {PIL.__version__}; "
            "run pip install --upgrade pillow",
            name="PIL",
        )


def _read_bit_depth(kind: str, head: bytes) -> int:
    if kind == "PNG":
        return head[PNG_BIT_DEPTH_OFFSET]
    if kind == "AVIF":
        return codecs.avif_depth(head)
    return 8


def _require_readable_mode(path: Path, mode: str, depth: int) -> None:
    """Raise OtherPixels for a mode or a depth that hdrlab does not read."""
    if mode == "CMYK":
        raise OtherPixels(f"{path}: {CMYK_REASON}")
    if depth < 8:
        pixels = f"{depth}-bit pixels"
    elif mode not in READ_MODES:
        pixels = MODE_NAMES.get(mode, mode)
    else:
        return
    raise OtherPixels(f"{path}: expected gray or RGB of 8 or 16 bits, got {pixels}")


def _read_jxl_header(path: Path, head: bytes) -> PhotoHeader:
    """Return the header of a JPEG XL, which states its orientation itself, whatever EXIF says."""
    facts = _read_exif(lambda: _load_exif(jpegxl.exif(head)))
    header = jpegxl.read_header(path, head)
    is_pq_or_hlg = header.transfer in (jpegxl.PQ_TRANSFER, jpegxl.HLG_TRANSFER)
    return PhotoHeader(
        path,
        "JXL",
        header.shape,
        header.dtype,
        orientation=header.orientation,
        exposure=facts.exposure,
        icc=profiles.DISPLAY_P3 if header.primaries == jpegxl.P3_PRIMARIES else b"",
        processing=IS_PQ_OR_HLG if is_pq_or_hlg else facts.processing,
        camera=facts.camera,
        taken=facts.taken,
    )


def _read_tiff_header(path: Path) -> PhotoHeader:
    """Return the header of the photo in a TIFF, which may not be the first page."""
    page = tiff_pages.read_page_facts(path)
    facts = _read_tiff_exif(path, page)
    return PhotoHeader(
        path,
        "TIFF",
        shape=page.shape,
        dtype=page.dtype,
        orientation=facts.orientation,
        exposure=facts.exposure,
        icc=facts.icc(page.icc),
        processing=facts.processing,
        comments=page.comments,
        camera=facts.camera,
        taken=facts.taken,
    )


def _read_tiff_exif(path: Path, page: tiff_pages.PageFacts) -> ExifFacts:
    """Return the EXIF of the photo in a TIFF, or else that of the first page."""
    with open(path, "rb") as stream:
        if page.is_big:  # Pillow reads its directories only as those of an image
            facts = _read_exif(lambda: Image.open(stream, formats=("TIFF",)).getexif())
        else:
            facts = _read_exif(partial(_load_tiff_exif, stream))
            own_facts = _read_exif(partial(_load_tiff_exif, stream, page.directory_offset))
            if own_facts.exposure.seconds is not None:
                return own_facts
    if page.is_first or page.orientation is None or not 1 <= page.orientation <= 8:
        return facts
    return replace(facts, orientation=page.orientation)


def _load_tiff_exif(stream: BinaryIO, directory_offset: int | None = None) -> Image.Exif:
    """Return the EXIF of a TIFF file, by default that of its first directory."""
    stream.seek(0)
    exif = Image.Exif()
    exif.load_from_fp(stream, directory_offset)
    return exif


def _load_exif(block: bytes | None) -> Image.Exif:
    """Return the EXIF of a block of bytes."""
    exif = Image.Exif()
    exif.load(block or b"")
    return exif


def _read_interop_index(exif: Image.Exif) -> object:
    """Return the tag that says whether a photo is in Adobe RGB, None without it."""
    try:
        return exif.get_ifd(ExifTags.IFD.Interop).get(INTEROP_INDEX_TAG)
    except KeyError:  # of a Pillow before 13, if EXIF has no part on interoperability
        return None


def _read_exif(load: Callable[[], Image.Exif]) -> ExifFacts:
    """Return what hdrlab uses of EXIF; unreadable EXIF states nothing, the photo may still be good."""
    try:
        with ignore_library_warnings():
            exif = load()
            orientation = exif.get(ExifTags.Base.Orientation, 1)
            exposure = read_exposure(exif)
            interop_index = _read_interop_index(exif)
            rendering = exif.get_ifd(ExifTags.IFD.Exif).get(ExifTags.Base.CustomRendered)
            camera = read_camera(exif)
            taken = read_time_taken(exif)
    except Exception:  # on damaged EXIF Pillow raises exceptions of any type
        return ExifFacts()
    return ExifFacts(
        orientation=orientation if orientation in range(1, 9) else 1,
        exposure=exposure,
        is_adobe_rgb=interop_index == INTEROP_ADOBE_RGB,
        is_blended=rendering in CUSTOM_RENDERED_HDR,
        camera=camera,
        taken=taken,
    )
