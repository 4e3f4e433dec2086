"""One photograph, in two steps: look at its header, then decode its pixels straight into their place.

What a file is, its first bytes say and not its suffix. Its pixels are decoded by hdrlab.io.codecs,
those of RAW by hdrlab.io.raw. Pillow reads EXIF. Colours of another space than sRGB are converted
by their ICC profile, see hdrlab.io.profiles.
"""

import re
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from PIL import ExifTags, Image

from hdrlab.core.arrays import Array
from hdrlab.core.optional import pillow_heif, tifffile
from hdrlab.errors import InputError
from hdrlab.io import codecs, jpegxl, profiles, raw
from hdrlab.io.exif_exposure import Exposure, exif_exposure
from hdrlab.io.files import OtherPixels, check_size, require_no_folder

# what the first bytes of a file of each kind are
MAGIC = {"TIFF": rb"II\*\0|MM\0\*", "JPEG": rb"\xff\xd8\xff", "PNG": rb"\x89PNG\r\n\x1a\n"}
MAGIC |= {
    "WEBP": rb"RIFF....WEBP",
    "AVIF": rb"....ftyp.*avi[fs]",
    "HEIF": rb"....ftyp(he[iv]|mif1|msf1)",
}
MAGIC |= {"JXL": rb"\xff\n|\0\0\0\x0cJXL \r\n\x87\n"}
# bytes of a picture in one of the file: more than any of these formats reaches
BEST_COMPRESSION_RATIO = 1 << 12
# ... and these, of which a black photograph takes hardly a kilobyte
RATIOS = dict.fromkeys(("WEBP", "AVIF", "HEIF", "JXL"), 1 << 16)
# words that stand near the beginning of a file with a gain map: Adobe's, ISO 21496-1, Apple's
GAIN_MAPS = (b"hdrgm:", b"urn:iso:std:iso:ts:21496", b"aux:hdrgainmap")
CODED = "is coded for an HDR screen, by PQ or HLG"
# ... as a PNG and an AVIF or HEIC say: the curve's number after that of the primaries
BEYOND_GAMMA = re.compile(rb"cICP.[\x10\x12]|nclx\0.\0[\x10\x12]", re.DOTALL)
LONGEST_HEADER = 1 << 18
MODES = {"1": "1-bit pixels", "P": "a palette", "PA": "a palette", "LAB": "Lab"}
# EXIF's CustomRendered: HDR, without and with the original, and portraits and panoramas of HDR [of
# Apple]
BLENDED = (2, 3, 6, 7)
MODES |= {"F": "floating point", "I": "32-bit integers"}
KINDS = {1: "MINISBLACK", 3: "RGB"}  # channels without alpha, and what TIFF calls them


class Header(NamedTuple):
    """What a photograph says before its pixels; `shape` is upright, (H, W) or (H, W, 3).

    `icc` is the profile of its colours, empty for sRGB; `processing` says what makes it useless in
    a bracket.
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


def look(path: str | Path, *, light: bool | None = False) -> Header:
    """Return the Header of the photograph at `path`, or raise a ValueError for what is not one.

    With `light` it is to hold floating-point samples, and with None any.
    """
    path = Path(path)
    require_no_folder(path, "a photo")
    if path.suffix.lower() in raw.SUFFIXES:
        size, exposure = raw.look(path)
        return Header(path, "RAW", size, np.dtype(np.uint16), 1, exposure)
    with open(path, "rb") as file:
        head = file.read(LONGEST_HEADER)
    kind = next(
        (kind for kind, magic in MAGIC.items() if re.match(magic, head[:32], re.DOTALL)), ""
    )
    if not kind:
        raise InputError(f"{path}: expected a photograph ({', '.join(MAGIC)}), got {head[:8]!r}")
    header = {"TIFF": _look_tiff, "JXL": _look_jxl}.get(kind, _look_pillow)(path, kind, head)
    shape, ratio = header.shape, RATIOS.get(kind, BEST_COMPRESSION_RATIO)
    check_size(path, shape[0], shape[1], int(np.prod(shape)) * header.dtype.itemsize // ratio)
    if light not in (None, header.dtype.kind == "f"):
        wanted, n = "floating-point samples" if light else "8 or 16 bits", (*header.shape, 1)[2]
        raise OtherPixels(
            f"{path}: expected gray or RGB of {wanted}, got {n} x {header.dtype}, {KINDS[n]}"
        )
    if header.orientation > 4:
        shape = (shape[1], shape[0], *shape[2:])
    gains = any(word in head for word in GAIN_MAPS)
    processing = (
        "has a gain map: the picture in it was tone-mapped locally" if gains else header.processing
    )
    processing = CODED if BEYOND_GAMMA.search(head) else processing
    return header._replace(shape=shape, processing=processing)


def decode(header: Header, out: Array, *, balance: raw.Balance | None = None) -> None:
    """Decode the photograph into `out`, of its upright shape; `balance` is a white balance for RAW."""
    if header.kind == "RAW":
        pixels = raw.decode(header.path, balance)
    else:
        stored = codecs.stored_pixels(
            header.path, header.kind, out if header.orientation == 1 else None
        )
        pixels = upright(opaque(header.path, stored), header.orientation)
        if header.icc and pixels.dtype.kind == "u":
            pixels = profiles.to_srgb(header.path, pixels, header.icc)
    if pixels.shape != out.shape or pixels.dtype != out.dtype:
        got = f"{pixels.shape} {pixels.dtype}"
        raise InputError(f"{header.path}: expected {out.shape} {out.dtype}, got {got}")
    if pixels is not out:
        out[...] = pixels


def upright(pixels: Array, orientation: int) -> Array:
    """Return stored pixels as they are to be seen: an EXIF orientation above 4 lies on its side."""
    turned = pixels.swapaxes(0, 1) if orientation > 4 else pixels
    down, across = orientation in (3, 4, 7, 8), orientation in (2, 3, 6, 7)
    return pixels if orientation == 1 else turned[:: -1 if down else 1, :: -1 if across else 1]


def opaque(path: Path, pixels: Array) -> Array:
    """Return pixels without their alpha channel, or raise a ValueError where levels are transparent."""
    if pixels.ndim < 3 or pixels.shape[2] == 3:
        return pixels
    if pixels.dtype.kind == "u" and (pixels[..., -1] != np.iinfo(pixels.dtype).max).any():
        raise InputError(
            f"{path}: expected gray or RGB, got an alpha channel with transparent pixels"
        )
    return pixels[..., 0] if pixels.shape[2] < 3 else pixels[..., :3]


def _look_pillow(path: Path, kind: str, head: bytes) -> Header:
    """Return what is stated by the header of a file that Pillow opens."""
    if kind == "HEIF":
        pillow_heif.register_heif_opener()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of sizes, which check_size judges, and of odd EXIF
            with Image.open(path, formats=(kind,)) as image:
                (width, height), mode, info = image.size, image.mode, dict(image.info)
        depth = {"PNG": lambda: head[24], "AVIF": lambda: codecs.avif_depth(head)}.get(
            kind, lambda: 8
        )()
    except Image.DecompressionBombError as error:
        raise InputError(f"{path}: its header claims an absurd size ({error})") from None
    except Exception as error:  # on damaged files Pillow raises what it likes
        raise InputError(
            f"{path}: expected a photograph, its header is damaged ({error})"
        ) from None
    depth = info.get("bit_depth", depth)
    mode = "an alpha channel" if "transparency" in info else mode
    if depth < 8 or mode not in ("L", "LA", "RGB", "RGBA", "I;16"):
        what = MODES.get(mode, mode) if depth >= 8 else f"{depth}-bit pixels"
        raise OtherPixels(f"{path}: expected gray or RGB of 8 or 16 bits, got {what}")
    colour = (
        head[25] & 2 if kind == "PNG" else mode.startswith("RGB")
    )  # of deep gray Pillow makes RGBA
    shape = (height, width, 3) if colour else (height, width)
    dtype = np.dtype(np.uint8 if depth == 8 else np.uint16)
    exif = _exif(lambda exif: exif.load(info.get("exif") or b""), info.get("icc_profile"))
    return Header(path, kind, shape, dtype, **exif)


def _look_jxl(path: Path, kind: str, head: bytes) -> Header:
    """Return what is stated by a JPEG XL; how it is turned, it says itself, and not its EXIF."""
    exif = _exif(lambda exif: exif.load(jpegxl.exif(head)), None)
    header = jpegxl.read_header(path, head)
    exif["orientation"] = header.orientation
    exif["icc"] = profiles.DISPLAY_P3 if header.primaries == jpegxl.P3_PRIMARIES else b""
    if header.transfer in (jpegxl.PQ_TRANSFER, jpegxl.HLG_TRANSFER):
        exif["processing"] = CODED
    return Header(path, kind, header.shape, header.dtype, **exif)


def _look_tiff(path: Path, form: str, head: bytes) -> Header:
    """Return what is stated by the first page of a TIFF file; floats may have any alpha channels."""
    open_tiff = tifffile.TiffFile
    try:
        with open_tiff(path) as file:
            page = file.pages.first
            height, width, deep = int(page.imagelength), int(page.imagewidth), int(page.imagedepth)
            channels, alpha = int(page.samplesperpixel), len(page.extrasamples)
            kind = str(getattr(page.photometric, "name", page.photometric))[:40]
            dtype, icc, comments = (
                np.dtype(page.dtype),
                page.iccprofile or b"",
                page.description.splitlines(),
            )
    except Exception as error:  # on damaged files tifffile raises what it likes
        why = str(error)[:200]
        raise InputError(f"{path}: expected a photograph, its header is damaged ({why})") from None
    light = dtype.kind == "f"
    colours = channels - (alpha if light else alpha == 1)
    if KINDS.get(colours) != kind or not (light or dtype in ("u1", "u2")):
        raise OtherPixels(
            f"{path}: expected gray or RGB of 8 or 16 bits, got {channels} x {dtype}, {kind}"
        )
    if deep != 1:
        raise OtherPixels(f"{path}: expected one picture, got {deep} on one another")
    with open(path, "rb") as stream:
        exif = _exif(lambda exif: exif.load_from_fp(stream), icc)
    return Header(
        path, form, (height, width, 3)[: 2 + (colours == 3)], dtype, comments=comments, **exif
    )


def _exif(load: Callable[[Image.Exif], None], icc: bytes | None) -> dict[str, Any]:
    """Return what EXIF adds to a Header; one that cannot be read adds nothing, the photograph may be good."""
    exif = Image.Exif()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            load(exif)
            orientation, exposure = exif.get(ExifTags.Base.Orientation, 1), exif_exposure(exif)
            adobe = exif.get_ifd(ExifTags.IFD.Interop).get(1) == "R03"  # [DCF 2.0]
            blended = exif.get_ifd(ExifTags.IFD.Exif).get(ExifTags.Base.CustomRendered) in BLENDED
    except Exception:
        return {"icc": icc or b""}
    return {
        "orientation": orientation if orientation in range(1, 9) else 1,
        "exposure": exposure,
        "icc": icc or (profiles.ADOBE if adobe else b""),
        "processing": "was put together by the camera out of several exposures" if blended else "",
    }
