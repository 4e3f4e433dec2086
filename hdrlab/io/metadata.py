"""Remove personal metadata from photos: location, serial numbers, owner, maker notes, thumbnails.

The coded pixels stay as they are, byte for byte, and so do the tags that describe the exposure.

- JPEG, PNG, WebP and JPEG XL are sequences of parts. Parts that hold the image and its colors are
  copied, EXIF is reduced to the tags in `KEPT_TAGS`, every other part is dropped.
- HEIC and AVIF address their parts by offset, so EXIF and XMP are overwritten where they stand.
- TIFF and RAW files address everything by offset. Personal tags are removed from each directory,
  and EXIF and XMP of embedded previews are overwritten. The RAW decoder needs the maker notes of a
  RAW file; they stay, and the result says so.

A file that cannot be cleaned raises FileFormatError. The result is searched for the coordinates
that were removed, so that a copy in some unknown place is an error as well.
"""

import re
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from PIL.ExifTags import GPS, IFD, Base

from hdrlab.core.optional import imagecodecs
from hdrlab.errors import FileFormatError
from hdrlab.io import raw
from hdrlab.io.boxes import Box, iter_boxes
from hdrlab.io.codecs import jpeg_parts
from hdrlab.io.tiff_directories import (
    BYTE_ORDERS,
    Directory,
    blank_value,
    iter_directories,
    read_byte_order,
    read_directory,
    read_first_directory,
    read_pointers,
    write_entries,
)

WHAT_TO_DO = "convert it to JPEG, or keep the metadata of all pictures with --keep-metadata"
MAKER_NOTES_STAY = (
    "hdrlab keeps the maker notes, which the RAW decoder needs; "
    "they may contain a serial number or the name of a place"
)

# EXIF tags that are kept in the directory of the image ...
KEPT_TAGS: set[int] = {
    Base.Make,
    Base.Model,
    Base.Orientation,
    Base.XResolution,
    Base.YResolution,
    Base.ResolutionUnit,
    Base.Software,
    Base.DateTime,
    Base.YCbCrPositioning,
}
# ... and in the directory of the camera's settings.
KEPT_SETTINGS: set[int] = {
    Base.ExposureTime,
    Base.FNumber,
    Base.ExposureProgram,
    Base.SpectralSensitivity,
    Base.ISOSpeedRatings,
    Base.SensitivityType,
    Base.StandardOutputSensitivity,
    Base.RecommendedExposureIndex,
    Base.ISOSpeed,
    Base.ISOSpeedLatitudeyyy,
    Base.ISOSpeedLatitudezzz,
    Base.ExifVersion,
    Base.DateTimeOriginal,
    Base.DateTimeDigitized,
    Base.ComponentsConfiguration,
    Base.CompressedBitsPerPixel,
    Base.ShutterSpeedValue,
    Base.ApertureValue,
    Base.BrightnessValue,
    Base.ExposureBiasValue,
    Base.MaxApertureValue,
    Base.SubjectDistance,
    Base.MeteringMode,
    Base.LightSource,
    Base.Flash,
    Base.FocalLength,
    Base.SubsecTime,
    Base.SubsecTimeOriginal,
    Base.SubsecTimeDigitized,
    Base.FlashPixVersion,
    Base.ColorSpace,
    Base.ExifImageWidth,
    Base.ExifImageHeight,
    Base.FocalPlaneXResolution,
    Base.FocalPlaneYResolution,
    Base.FocalPlaneResolutionUnit,
    Base.ExposureIndex,
    Base.SensingMethod,
    Base.FileSource,
    Base.SceneType,
    Base.CustomRendered,
    Base.ExposureMode,
    Base.WhiteBalance,
    Base.DigitalZoomRatio,
    Base.FocalLengthIn35mmFilm,
    Base.SceneCaptureType,
    Base.GainControl,
    Base.Contrast,
    Base.Saturation,
    Base.Sharpness,
    Base.DeviceSettingDescription,
    Base.SubjectDistanceRange,
    Base.LensSpecification,
    Base.LensMake,
    Base.LensModel,
    Base.Gamma,
}
# What personal tags tell, in words for the user.
PERSONAL_TAGS: dict[int, str] = {
    IFD.GPSInfo: "location",
    Base.BodySerialNumber: "serial numbers",
    Base.LensSerialNumber: "serial numbers",
    Base.CameraSerialNumber: "serial numbers",
    Base.ImageUniqueID: "serial numbers",
    Base.CameraOwnerName: "owner",
    Base.Artist: "artist",
    Base.Copyright: "copyright",
    Base.UserComment: "comment",
    Base.ImageDescription: "description",
    Base.XPTitle: "description",
    Base.XPComment: "comment",
    Base.XPAuthor: "artist",
    Base.XPKeywords: "description",
    Base.XPSubject: "description",
    Base.XMLPacket: "XMP",
    Base.IPTCNAA: "IPTC",
    Base.ImageResources: "IPTC",
    Base.OffsetTime: "time zone",
    Base.OffsetTimeOriginal: "time zone",
    Base.OffsetTimeDigitized: "time zone",
}
GPS_COORDINATES = (GPS.GPSLatitude, GPS.GPSLongitude, GPS.GPSDestLatitude, GPS.GPSDestLongitude)

EXIF_PREFIX = b"Exif\0\0"
PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"
PNG_KEPT_CHUNKS = set(
    b"IHDR PLTE IDAT IEND gAMA cHRM sRGB iCCP sBIT pHYs tRNS cICP mDCV mDCv cLLI cLLi bKGD"
    b" hIST".split()
)
WEBP_KEPT_CHUNKS = {b"VP8X", b"VP8 ", b"VP8L", b"ALPH", b"ANIM", b"ANMF", b"ICCP"}
WEBP_EXIF_FLAG = 0x08
WEBP_XMP_FLAG = 0x04
JXL_SIGNATURE_BOX = b"\0\0\0\x0cJXL \r\n\x87\n"
JXL_KEPT_BOXES = {b"JXL ", b"ftyp", b"jxlc", b"jxlp", b"jxll", b"jxli", b"jhgm"}
MAX_JXL_EXIF_BYTES = 2**24
# Top-level boxes of HEIC and AVIF that hold the image.
HEIF_KEPT_BOXES = {b"ftyp", b"meta", b"mdat", b"moov", b"idat", b"free", b"skip", b"wide"}
# Inside `moov`, of image sequences.
PERSONAL_MOVIE_BOXES = {b"udta", b"meta", b"uuid"}
CONTAINER_BOXES = {b"moov", b"trak", b"mdia"}
HEIF_OR_CR3 = re.compile(rb"....ftyp(crx |he[iv]|mif1|msf1|.{0,20}avi[fs])", re.DOTALL)
CR3_CANON_UUID = bytes.fromhex("85c0b687820f11e08111f4ce462b6a48")
CR3_XMP_UUID = bytes.fromhex("be7acfcb97a942e89c71999491e3afac")

# Segments of JPEGs that are embedded in RAW files: EXIF, XMP, and Photoshop's with IPTC.
EMBEDDED_EXIF = re.compile(rb"\xff\xe1(..)Exif\0\0(?=II\*\0|MM\0\*)", re.DOTALL)
EMBEDDED_XMP = re.compile(rb"\xff\xe1(..)http://ns\.adobe\.com/[a-z0-9./]+\0", re.DOTALL)
EMBEDDED_IPTC = re.compile(rb"\xff\xed(..)Photoshop 3\.0\0", re.DOTALL)


@dataclass(frozen=True)
class CleanedFile:
    """A file without personal metadata: what was removed, and what may remain, in words."""

    data: bytes
    removed: frozenset[str]
    remaining: str = ""


def strip_metadata(path: str | Path, data: bytes | None = None) -> CleanedFile:
    """Return a photo's bytes without location, serial numbers and other personal metadata.

    Parameters
    ----------
    path : str or Path
        The file. Its suffix tells RAW files from TIFF.
    data : bytes, optional
        The content of the file; it is read from `path` by default.

    Returns
    -------
    CleanedFile
        Pixels, exposure and camera model are those of the original.

    Raises
    ------
    FileFormatError
        For a format that hdrlab cannot clean, and for a damaged file.
    """
    if data is None:
        data = Path(path).read_bytes()
    try:
        cleaned = _clean(Path(path).suffix.lower(), data)
        if cleaned is not None:
            _require_no_coordinates(data, cleaned.data)
    except (struct.error, IndexError, ValueError) as error:
        raise FileFormatError(
            f"{path}: cannot remove the metadata, because the file is damaged or unusual "
            f"({error}); {WHAT_TO_DO}"
        ) from None
    if cleaned is None:
        raise FileFormatError(
            f"{path}: hdrlab cannot remove the metadata of this format; {WHAT_TO_DO}"
        )
    return cleaned


def is_photo(data: bytes) -> bool:
    """Return whether a file begins as a photo of a known format does, whatever its suffix says."""
    begins_as_photo = data.startswith(
        (b"\xff\xd8\xff", PNG_SIGNATURE, JXL_SIGNATURE_BOX, b"FUJIFILMCCD-RAW", *BYTE_ORDERS)
    )
    is_webp = data[:4] == b"RIFF" and data[8:12] == b"WEBP"
    return begins_as_photo or is_webp or HEIF_OR_CR3.match(data) is not None


def _clean(suffix: str, data: bytes) -> CleanedFile | None:
    """Clean a file by the format that its first bytes show; None for an unknown one."""
    is_raw = suffix in raw.SUFFIXES
    if data[:2] == b"\xff\xd8":
        return _clean_jpeg(data)
    if data[:8] == PNG_SIGNATURE:
        return _clean_png(data)
    if data[:4] == b"RIFF" and data[8:12] == b"WEBP":
        return _clean_webp(data)
    if data[:2] == b"\xff\x0a":  # a bare JPEG XL codestream has no place for metadata
        return CleanedFile(data, frozenset())
    if data[:12] == JXL_SIGNATURE_BOX:
        return _clean_jxl(data)
    if data[4:12] == b"ftypcrx ":
        return _clean_cr3(data)
    if HEIF_OR_CR3.match(data):
        return _clean_heif(data)
    if data[:15] == b"FUJIFILMCCD-RAW":
        return _clean_raf(data)
    if data[:4] in BYTE_ORDERS:
        return _clean_tiff(data, is_raw=is_raw or data[:4] not in (b"II*\0", b"MM\0*"))
    return None


# EXIF


def keep_exposure_tags(block: bytes) -> tuple[bytes, set[str]]:
    """Reduce EXIF to `KEPT_TAGS` and `KEPT_SETTINGS`, and name the personal data that it had.

    What is kept stands at its old offset, and everything else becomes zero, so that the block can
    be written back in place. The block ends with the last byte that is kept. A block that cannot be
    read becomes empty.
    """
    try:
        byte_order = read_byte_order(block)
        image = read_first_directory(block)
        pointers = read_pointers(block, image, IFD.Exif)
        settings = read_directory(block, pointers[0]) if pointers else None
        removed = _name_personal_data(block)
    except (FileFormatError, struct.error):
        return b"", {"unreadable EXIF"}
    out = bytearray(len(block))
    out[:8] = block[:8]
    kept_tags = {*KEPT_TAGS, IFD.Exif} if settings else KEPT_TAGS
    end = _copy_entries(out, block, image, kept_tags, byte_order)
    if settings:
        end = max(end, _copy_entries(out, block, settings, KEPT_SETTINGS, byte_order))
    return bytes(out[:end]), removed


def _copy_entries(
    out: bytearray, block: bytes, directory: Directory, tags: set[int], byte_order: str
) -> int:
    """Copy the entries with some tags, and return the offset behind the last byte written."""
    kept = [entry for entry in directory.entries if entry.value and entry.tag in tags]
    out[directory.offset : directory.end] = block[directory.offset : directory.end]
    write_entries(out, directory, kept, 0, byte_order)
    end = directory.offset + 2 + 12 * len(kept) + 4
    for entry in kept:
        value_end = entry.value_offset + len(entry.value)
        if not directory.offset <= entry.value_offset < directory.end:
            out[entry.value_offset : value_end] = entry.value
            end = max(end, value_end)
    return end


def _name_personal_data(block: bytes | bytearray) -> set[str]:
    """Name what a TIFF block tells beyond the exposure."""
    first = read_first_directory(block)
    names = {"thumbnail"} if first.next_offset else set()
    for directory in iter_directories(block):
        names |= {name for tag, name in PERSONAL_TAGS.items() if tag in directory.tags}
        if Base.MakerNote in directory.tags:
            names.add("maker notes")
    return names


def _clean_prefixed_exif(payload: bytes) -> tuple[bytes, set[str]]:
    """Clean EXIF that may stand behind "Exif" and two zeros."""
    prefix = EXIF_PREFIX if payload.startswith(EXIF_PREFIX) else b""
    kept, removed = keep_exposure_tags(payload[len(prefix) :])
    return (prefix + kept if kept else b""), removed


def _clean_exif_box(payload: bytes) -> tuple[bytes, set[str]]:
    """Clean EXIF behind the offset of its TIFF header, as HEIC, AVIF and JPEG XL store it."""
    (offset,) = struct.unpack_from(">L", payload)
    kept, removed = keep_exposure_tags(payload[4 + offset :])
    return struct.pack(">L", 0) + kept, removed


def _blank_xml(length: int) -> bytes:
    """Return an empty XML document of some length."""
    return b"<x/>".ljust(length)[:length]


# Formats that are sequences of parts


def _clean_jpeg(data: bytes) -> CleanedFile:
    out = bytearray(b"\xff\xd8")
    removed: set[str] = set()
    marker = 0
    end = 2
    for next_marker, start, end in jpeg_parts(data):
        previous_marker = marker
        marker = next_marker
        body = data[start:end]
        is_metadata = 0xE0 <= marker <= 0xEF or marker == 0xFE
        if is_metadata:
            body, personal = _clean_jpeg_segment(marker, body)
            removed |= personal
            if not body:
                continue
        elif not marker and previous_marker != 0xDA and body.strip(b"\xff"):
            raise FileFormatError("there are bytes between two segments of the JPEG")
        if marker:
            out += bytes((0xFF, marker))
        if marker not in (0, 0xD9):
            out += struct.pack(">H", len(body) + 2)
        out += body
    if end < len(data):
        removed.add("data behind the image")
    return CleanedFile(bytes(out), frozenset(removed))


def _clean_jpeg_segment(marker: int, body: bytes) -> tuple[bytes, set[str]]:
    """Return what is kept of an application's segment or of a comment, and name what is not."""
    if marker == 0xE1 and body.startswith(EXIF_PREFIX):
        return _clean_prefixed_exif(body)
    if marker == 0xE0 and body.startswith(b"JFIF\0"):
        size_of_no_thumbnail = bytes(2)
        return (body[:12] + size_of_no_thumbnail if len(body) >= 14 else body), set()
    if marker == 0xEE and body.startswith(b"Adobe"):
        return body, set()
    if marker == 0xE2 and body.startswith(b"ICC_PROFILE\0"):
        return body, set()
    if b"GPS" in body:
        return b"", {"location"}
    return b"", {"comment" if marker == 0xFE else "metadata of other programs"}


def _clean_png(data: bytes) -> CleanedFile:
    out = bytearray(PNG_SIGNATURE)
    removed: set[str] = set()
    offset = len(PNG_SIGNATURE)
    chunk_type = b""
    while chunk_type != b"IEND":
        length, chunk_type = struct.unpack_from(">L4s", data, offset)
        body = data[offset + 8 : offset + 8 + length]
        if len(body) < length:
            raise FileFormatError("the PNG is cut short")
        if chunk_type == b"eXIf":
            body, personal = _clean_prefixed_exif(body)
            removed |= personal
        elif chunk_type not in PNG_KEPT_CHUNKS:
            removed.add("location" if b"GPS" in body else "metadata of other programs")
            body = b""
        if body or chunk_type == b"IEND":
            checksum = zlib.crc32(chunk_type + body)
            out += struct.pack(">L4s", len(body), chunk_type) + body + struct.pack(">L", checksum)
        offset += 12 + length
    if offset < len(data):
        removed.add("data behind the image")
    return CleanedFile(bytes(out), frozenset(removed))


def _clean_webp(data: bytes) -> CleanedFile:
    removed: set[str] = set()
    chunks = []
    end = min(8 + int.from_bytes(data[4:8], "little"), len(data))
    offset = 12
    while offset + 8 <= end:
        chunk_type, length = struct.unpack_from("<4sL", data, offset)
        body = data[offset + 8 : offset + 8 + length]
        if len(body) < length:
            raise FileFormatError("the WebP is cut short")
        if chunk_type == b"EXIF":
            body, personal = _clean_prefixed_exif(body)
            removed |= personal
        elif chunk_type not in WEBP_KEPT_CHUNKS:
            removed.add("XMP" if chunk_type == b"XMP " else "metadata of other programs")
            body = b""
        if body:
            chunks.append((chunk_type, body))
        offset += 8 + length + length % 2
    if offset < len(data):
        removed.add("data behind the image")
    has_exif = any(chunk_type == b"EXIF" for chunk_type, _ in chunks)
    out = bytearray(b"WEBP")
    for chunk_type, body in chunks:
        if chunk_type == b"VP8X":
            flags = body[0] & ~WEBP_XMP_FLAG
            if not has_exif:
                flags &= ~WEBP_EXIF_FLAG
            body = bytes([flags]) + body[1:]
        out += struct.pack("<4sL", chunk_type, len(body)) + body + bytes(len(body) % 2)
    return CleanedFile(b"RIFF" + struct.pack("<L", len(out)) + bytes(out), frozenset(removed))


def _clean_jxl(data: bytes) -> CleanedFile:
    out = bytearray()
    removed: set[str] = set()
    for box in iter_boxes(data):
        box_type = box.type
        body = data[box.content_start : box.end]
        if box_type == b"brob" and body[:4] == b"Exif":
            box_type = b"Exif"
            body = bytes(imagecodecs.brotli_decode(body[4:], out=bytearray(MAX_JXL_EXIF_BYTES)))
        if box_type == b"Exif":
            body, personal = _clean_exif_box(body)
            removed |= personal
        elif box_type not in JXL_KEPT_BOXES:
            is_xmp = box_type == b"xml " or body[:4] == b"xml "
            removed.add("XMP" if is_xmp else "metadata of other programs")
            continue
        out += struct.pack(">L4s", len(body) + 8, box_type) + body
    return CleanedFile(bytes(out), frozenset(removed))


# Formats that address their parts by offset


def _clean_heif(data: bytes) -> CleanedFile:
    out = bytearray(data)
    removed: set[str] = set()
    has_meta = False
    for box in iter_boxes(data):
        if box.type == b"meta":
            has_meta = True
            removed |= _blank_heif_items(out, data, box)
        elif box.type == b"moov":
            removed |= _blank_movie_metadata(out, data, box)
        elif box.type not in HEIF_KEPT_BOXES:
            _free_box(out, box)
            removed.add("metadata of other programs")
    if not has_meta:
        raise FileFormatError("it has no meta box")
    return CleanedFile(bytes(out), frozenset(removed))


def _free_box(out: bytearray, box: Box) -> None:
    """Turn a box into free space."""
    out[box.start + 4 : box.start + 8] = b"free"
    out[box.content_start : box.end] = bytes(box.end - box.content_start)


def _blank_movie_metadata(out: bytearray, data: bytes, parent: Box) -> set[str]:
    """Turn the metadata of an image sequence into free space."""
    removed: set[str] = set()
    for box in iter_boxes(data, parent.content_start, parent.end):
        if box.type in CONTAINER_BOXES:
            removed |= _blank_movie_metadata(out, data, box)
        elif box.type in PERSONAL_MOVIE_BOXES:
            _free_box(out, box)
            removed.add("metadata of other programs")
    return removed


def _blank_heif_items(out: bytearray, data: bytes, meta: Box) -> set[str]:
    """Clean the EXIF items of a HEIC or AVIF file in place, and blank its XMP items."""
    removed: set[str] = set()
    children = {}
    for box in iter_boxes(data, meta.content_start + 4, meta.end):
        children[box.type] = box
        if box.type in (b"uuid", b"udta"):
            _free_box(out, box)
            removed.add("metadata of other programs")
    if b"iinf" not in children:
        return removed
    item_types = _read_item_types(data, children[b"iinf"])
    extents = _read_item_extents(data, children)
    for item_id, item_type in item_types.items():
        if item_type not in (b"Exif", b"mime", b"uri "):
            continue
        ranges = extents.get(item_id, [])
        if not ranges:
            raise FileFormatError("its metadata is not where hdrlab can overwrite it")
        payload = b"".join(data[start:end] for start, end in ranges)
        if item_type == b"Exif":
            cleaned, personal = _clean_exif_box(payload)
            cleaned = cleaned.ljust(len(payload), b"\0")
            removed |= personal
        else:
            cleaned = _blank_xml(len(payload))
            if cleaned != payload:
                removed.add("XMP")
        for start, end in ranges:
            out[start:end] = cleaned[: end - start]
            cleaned = cleaned[end - start :]
    return removed


def _read_item_types(data: bytes, iinf: Box) -> dict[int, bytes]:
    """Return the type of each item of a HEIC or AVIF file [ISO 14496-12, 8.11.6]."""
    entries_start = iinf.content_start + (6 if data[iinf.content_start] == 0 else 8)
    types = {}
    for entry in iter_boxes(data, entries_start, iinf.end):
        version = data[entry.content_start]
        if version == 2:
            item_id, item_type = struct.unpack_from(">H2x4s", data, entry.content_start + 4)
        elif version == 3:
            item_id, item_type = struct.unpack_from(">L2x4s", data, entry.content_start + 4)
        else:
            raise FileFormatError(f"hdrlab does not read version {version} of its item entries")
        types[item_id] = item_type
    return types


def _read_item_extents(data: bytes, meta: dict[bytes, Box]) -> dict[int, list[tuple[int, int]]]:
    """Return where the bytes of each item are: (start, end), in pieces [ISO 14496-12, 8.11.3]."""
    reader = _ByteReader(data, meta[b"iloc"].content_start)
    version = reader.read(1)
    reader.read(3)
    sizes = reader.read(2)
    offset_size = sizes >> 12
    length_size = sizes >> 8 & 15
    base_offset_size = sizes >> 4 & 15
    index_size = sizes & 15 if version > 0 else 0
    id_size = 2 if version < 2 else 4
    item_count = reader.read(id_size)
    extents: dict[int, list[tuple[int, int]]] = {}
    for _ in range(item_count):
        item_id = reader.read(id_size)
        construction_method = reader.read(2) & 15 if version > 0 else 0
        data_reference = reader.read(2)
        base_offset = reader.read(base_offset_size)
        if construction_method == 1:
            base_offset += meta[b"idat"].content_start
        extent_count = reader.read(2)
        ranges = []
        for _ in range(extent_count):
            reader.read(index_size)
            start = base_offset + reader.read(offset_size)
            length = reader.read(length_size)
            end = start + length if length else len(data)
            ranges.append((start, end))
        is_elsewhere = construction_method > 1 or data_reference != 0
        is_cut = any(end > len(data) for _, end in ranges)
        # The image may be stored in any way. Only metadata has to be in this file, and in one piece
        # or several: an empty list tells the caller that it is not.
        extents[item_id] = [] if is_elsewhere or is_cut else ranges
    return extents


class _ByteReader:
    """Reads big-endian numbers one after the other."""

    def __init__(self, data: bytes, offset: int) -> None:
        self._data = data
        self._offset = offset

    def read(self, size: int) -> int:
        """Return the next number, of `size` bytes."""
        start = self._offset
        self._offset += size
        if self._offset > len(self._data):
            raise FileFormatError("it ends within a table")
        return int.from_bytes(self._data[start : self._offset], "big")


def _clean_tiff(data: bytes, *, is_raw: bool) -> CleanedFile:
    cleaned, removed = _remove_personal_tags(data, keep_maker_notes=is_raw)
    if not is_raw:
        return CleanedFile(cleaned, frozenset(removed))
    out = bytearray(cleaned)
    removed |= _clean_embedded_jpegs(out)
    return CleanedFile(bytes(out), frozenset(removed), MAKER_NOTES_STAY)


def _remove_personal_tags(block: bytes, *, keep_maker_notes: bool) -> tuple[bytes, set[str]]:
    """Remove the personal tags of every directory of a TIFF block, in place."""
    out = bytearray(block)
    byte_order = read_byte_order(block)
    names = dict(PERSONAL_TAGS)
    if not keep_maker_notes:
        names[Base.MakerNote] = "maker notes"
    removed: set[str] = set()
    for directory in iter_directories(block):
        kept = []
        for entry in directory.entries:
            if directory.is_gps:
                blank_value(out, entry)
            elif entry.tag in names:
                blank_value(out, entry)
                removed.add(names[entry.tag])
            else:
                kept.append(entry)
        if directory.is_gps or len(kept) < len(directory.entries):
            next_offset = 0 if directory.is_gps else directory.next_offset
            write_entries(out, directory, kept, next_offset, byte_order)
    return bytes(out), removed


def _clean_embedded_jpegs(out: bytearray) -> set[str]:
    """Clean EXIF, XMP and IPTC of the JPEGs that are embedded in a RAW file, in place."""
    removed: set[str] = set()
    for match in EMBEDDED_EXIF.finditer(bytes(out)):
        end = match.start() + 2 + int.from_bytes(match[1], "big")
        block, personal = _remove_personal_tags(
            bytes(out[match.end() : end]), keep_maker_notes=True
        )
        out[match.end() : end] = block
        removed |= personal
    for pattern, name in ((EMBEDDED_XMP, "XMP"), (EMBEDDED_IPTC, "IPTC")):
        for match in pattern.finditer(bytes(out)):
            end = min(match.start() + 2 + int.from_bytes(match[1], "big"), len(out))
            blank = bytes(end - match.end())
            if name == "XMP":
                blank = _blank_xml(len(blank))
            if out[match.end() : end] != blank:
                out[match.end() : end] = blank
                removed.add(name)
    return removed


def _clean_raf(data: bytes) -> CleanedFile:
    """Clean the JPEG with which Fujifilm's RAF begins; it holds the EXIF."""
    if not EMBEDDED_EXIF.search(data):
        raise FileFormatError("the RAF file has no EXIF where hdrlab looks for it")
    out = bytearray(data)
    removed = _clean_embedded_jpegs(out)
    return CleanedFile(bytes(out), frozenset(removed), MAKER_NOTES_STAY)


def _clean_cr3(data: bytes) -> CleanedFile:
    """Clean Canon's CR3, whose boxes CMT1 to CMT4 are image tags, settings, maker notes and GPS."""
    out = bytearray(data)
    removed: set[str] = set()
    has_tags = False
    for box in _iter_cr3_boxes(data):
        block = data[box.content_start : box.end]
        if box.type in (b"CMT1", b"CMT2"):
            has_tags = True
            block, personal = _remove_personal_tags(block, keep_maker_notes=True)
            removed |= personal
        elif box.type == b"CMT4":
            if read_first_directory(block).entries:
                removed.add("location")
            block = block[:8].ljust(len(block), b"\0")
        elif box.type == b"uuid":  # XMP
            content = block[16:]
            block = block[:16] + _blank_xml(len(content))
            if block[16:] != content:
                removed.add("XMP")
        out[box.content_start : box.end] = block
    if not has_tags:
        raise FileFormatError("the CR3 file has no EXIF where hdrlab looks for it")
    removed |= _clean_embedded_jpegs(out)
    return CleanedFile(bytes(out), frozenset(removed), MAKER_NOTES_STAY)


def _iter_cr3_boxes(data: bytes) -> Iterator[Box]:
    """Yield the boxes CMT1, CMT2 and CMT4 of a CR3 file, and that of its XMP."""
    for box in iter_boxes(data):
        if box.type == b"uuid" and data[box.content_start :][:16] == CR3_XMP_UUID:
            yield box
        if box.type != b"moov":
            continue
        for child in iter_boxes(data, box.content_start, box.end):
            if child.type == b"uuid" and data[child.content_start :][:16] == CR3_CANON_UUID:
                for tags in iter_boxes(data, child.content_start + 16, child.end):
                    if tags.type in (b"CMT1", b"CMT2", b"CMT4"):
                        yield tags


# The check at the end


def _require_no_coordinates(original: bytes, cleaned: bytes) -> None:
    """Raise FileFormatError if coordinates of the original still stand in the cleaned file."""
    for coordinates in _find_coordinates(original):
        if coordinates in cleaned:
            raise FileFormatError("a second copy of the location is in an unknown place")


def _find_coordinates(data: bytes) -> set[bytes]:
    """Return the values of latitude and longitude in all TIFF and EXIF blocks, in both byte orders."""
    coordinates: set[bytes] = set()
    for match in re.finditer(rb"II\*\0|MM\0\*|^II[RU].|^MMOR", data, re.DOTALL):
        block = data[match.start() :]
        if match.start() and not _is_probably_tiff(block):
            continue
        try:
            directories = list(iter_directories(block))
        except (FileFormatError, struct.error):
            continue
        for directory in directories:
            if not directory.is_gps:
                continue
            for entry in directory.entries:
                if entry.tag not in GPS_COORDINATES or len(entry.value) != 24:
                    continue
                words = struct.unpack("<6L", entry.value)
                if any(words[::2]):
                    coordinates |= {entry.value, struct.pack(">6L", *words)}
    return coordinates


def _is_probably_tiff(block: bytes) -> bool:
    """Return whether the first directory stands right behind the header, as in EXIF."""
    try:
        return read_first_directory(block).offset <= 64
    except (FileFormatError, struct.error):
        return False
