"""Find the photo in a TIFF file, and decode it, through tifffile.

A TIFF file holds one or more pages, each with its directory of tags, and a page may have pages
below it. Cameras and scanners put a thumbnail first. The photo is the page with the most pixels.
"""

import io
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from hdrlab.core.arrays import Array
from hdrlab.core.optional import simplejpeg, tifffile
from hdrlab.errors import FileFormatError
from hdrlab.io.files import CMYK_REASON, OtherPixels

# The name of images with so many channels, without alpha.
PHOTOMETRIC = {1: "MINISBLACK", 3: "RGB"}
# More pages than any photo has, with its thumbnails, previews and masks.
MAX_PAGES = 32
JPEG_COMPRESSION = 7
ORIENTATION_TAG = 274
# Bytes of the marker at the beginning and at the end of a JPEG.
JPEG_MARKER_BYTES = 2
# A tile may be larger than the image, but not without limit.
MAX_TILE_TO_IMAGE_RATIO = 4
MIN_TILE_LIMIT_SAMPLES = 2**24
# Why hdrlab does not read other pages, by the name of what their samples mean.
OTHER_PIXELS = {
    "SEPARATED": CMYK_REASON,
    "YCBCR": "its pixels are YCbCr without JPEG compression; save it as RGB",
    "PALETTE": "expected gray or RGB of 8 or 16 bits, got a palette",
    "CIELAB": "its colors are Lab; save it as RGB",
    "ICCLAB": "its colors are Lab; save it as RGB",
    "CFA": "it holds the raw values of a sensor; name a DNG file .dng, or develop it",
    "LINEAR_RAW": "it holds the raw values of a sensor; name a DNG file .dng, or develop it",
}


@dataclass(frozen=True)
class PageFacts:
    """What a TIFF file states about its photo.

    Attributes
    ----------
    shape
        The stored shape, (H, W) or (H, W, 3), without alpha.
    dtype
        The type of the samples.
    icc
        The color profile, or None.
    comments
        The lines of the description.
    directory_offset
        Where the directory of the photo begins.
    is_first
        Whether the photo is the first page.
    orientation
        EXIF's orientation in the directory of the photo, or None.
    is_big
        Whether the file is a BigTIFF.
    """

    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    icc: bytes | None
    comments: list[str]
    directory_offset: int
    is_first: bool
    orientation: int | None
    is_big: bool


def read_page_facts(path: Path) -> PageFacts:
    """Return what a TIFF file states about its photo; floating-point pages may have alpha channels.

    Raises
    ------
    FileFormatError
        For a file that is damaged.
    OtherPixels
        For an image with other pixels than gray or RGB.
    """
    open_tiff = tifffile.TiffFile  # outside `try`: it may say what to install
    try:
        with open_tiff(path) as file:
            page = _find_full_page(file)
            height = int(page.imagelength)
            width = int(page.imagewidth)
            slices = int(page.imagedepth)
            channels = int(page.samplesperpixel)
            alpha_channels = len(page.extrasamples)
            photometric = _name_photometric(page)
            dtype = np.dtype(page.dtype)
            facts = PageFacts(
                shape=(height, width),
                dtype=dtype,
                icc=page.iccprofile or file.pages.first.iccprofile,
                comments=page.description.splitlines(),
                directory_offset=int(page.offset),
                is_first=page.offset == file.pages.first.offset,
                orientation=_read_orientation(page),
                is_big=bool(file.is_bigtiff),
            )
    except Exception as error:  # on damaged files tifffile raises exceptions of any type
        reason = str(error)[:200]
        raise FileFormatError(
            f"{path}: expected a photograph, its header is damaged ({reason})"
        ) from None
    is_floating = dtype.kind == "f"
    color_channels = channels
    if is_floating:
        color_channels -= alpha_channels
    elif alpha_channels == 1:
        color_channels -= 1
    is_readable_type = is_floating or dtype in (np.dtype("u1"), np.dtype("u2"))
    is_inverse_gray = photometric == "MINISWHITE" and channels == 1 and not is_floating
    is_readable = PHOTOMETRIC.get(color_channels) == photometric or is_inverse_gray
    if not is_readable or not is_readable_type:
        default_reason = (
            f"expected gray or RGB of 8 or 16 bits, got {channels} x {dtype}, {photometric}"
        )
        raise OtherPixels(f"{path}: {OTHER_PIXELS.get(photometric, default_reason)}")
    if slices != 1:
        raise OtherPixels(f"{path}: expected one image, got a stack of {slices}")
    return facts if color_channels == 1 else replace(facts, shape=(height, width, 3))


def decode_photo(data: bytes, out: Array | None = None) -> Array:
    """Decode the photo of a TIFF file, in the byte order of this machine; 0 is black.

    Raises
    ------
    ValueError
        For a file that is damaged.
    """
    with tifffile.TiffFile(io.BytesIO(data)) as file:
        page = _find_full_page(file)
        segments = list(zip(page.dataoffsets, page.databytecounts, strict=True))
        data_end = max((offset + size for offset, size in segments), default=0)
        if data_end > len(data):
            raise FileFormatError("its pixels go past the end of the file")
        tile_limit = max(MAX_TILE_TO_IMAGE_RATIO * np.prod(page.shape), MIN_TILE_LIMIT_SAMPLES)
        if np.prod(page.chunks) > tile_limit:
            raise FileFormatError("its tiles go far beyond the image")
        if page.compression == JPEG_COMPRESSION:
            _require_sound_jpegs(page, data, segments)
        pixels = page.asarray()
        is_planar = page.planarconfig == tifffile.PLANARCONFIG.SEPARATE
        is_inverse = _name_photometric(page) == "MINISWHITE"
    if is_planar and pixels.ndim == 3:
        pixels = np.moveaxis(pixels, 0, -1)
    pixels = pixels.astype(pixels.dtype.newbyteorder("="), copy=False)
    return ~pixels if is_inverse else pixels


def _find_full_page(file: Any) -> Any:
    """Return the page with the most pixels that is no mask, and no thumbnail by its tags."""
    candidates = [page for page in islice(_iter_pages(file), MAX_PAGES) if not page.is_mask]
    if not candidates:
        return file.pages.first

    def rank(page: Any) -> tuple[bool, int]:
        return not page.is_reduced, int(page.imagelength) * int(page.imagewidth)

    return max(candidates, key=rank)  # of equal pages, the first


def _iter_pages(file: Any) -> Iterator[Any]:
    """Yield the pages of a file, each followed by those below it, until one is damaged."""
    yield file.pages.first
    try:
        for index, page in enumerate(file.pages):
            if index > 0:
                yield page
            if page.subifds:
                yield from page.pages
    except Exception:  # the first page is sound, and tifffile raises exceptions of any type
        return


def _name_photometric(page: Any) -> str:
    """Return the name of what the samples mean once they are decoded."""
    name = str(getattr(page.photometric, "name", page.photometric))[:40]
    # Decoders of JPEG convert YCbCr to RGB.
    is_jpeg_color = page.compression == JPEG_COMPRESSION and page.samplesperpixel == 3
    return "RGB" if name == "YCBCR" and is_jpeg_color else name


def _read_orientation(page: Any) -> int | None:
    tag = page.tags.get(ORIENTATION_TAG)
    return None if tag is None else int(tag.value)


def _require_sound_jpegs(page: Any, data: bytes, segments: list[tuple[int, int]]) -> None:
    """Raise a ValueError if a strip or tile of JPEG is damaged, which imagecodecs does not report."""
    if not simplejpeg or page.bitspersample != 8:
        return
    tables = page.jpegtables
    for offset, size in segments:
        if size == 0:  # a missing tile is black
            continue
        segment = data[offset : offset + size]
        if tables:
            segment = tables[:-JPEG_MARKER_BYTES] + segment[JPEG_MARKER_BYTES:]
        color_space = simplejpeg.decode_jpeg_header(segment)[2]
        simplejpeg.decode_jpeg(segment, "GRAY" if color_space == "Gray" else "RGB", strict=True)
