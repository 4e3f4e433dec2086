"""Location, serial numbers and owner are removed from photos; pixels and exposure stay."""

import contextlib
import io
import json
import shutil
import struct
import subprocess

import imagecodecs
import numpy as np
import pytest
import tifffile
from hypothesis import given, strategies as st
from PIL import Image, ImageCms
from PIL.PngImagePlugin import PngInfo
from support.codec_features import require_avif

from hdrlab.io import metadata
from hdrlab.io.decode import read_header
from hdrlab.io.photos import read_photo

XMP = b'<x:xmpmeta xmlns:x="adobe:ns:meta/">exif:GPSLatitude 51,30.5N XMP-PLACE</x:xmpmeta>'
SECRETS = (b"SERIAL-4711", b"LENS-0815", b"Ada Owner", b"XMP-PLACE", b"home address", b"HIDDEN")
LATITUDE = (51, 1, 30, 1, 4711, 13)  # degrees, minutes and seconds, each a fraction
PACKED_LATITUDES = (struct.pack("<6L", *LATITUDE), struct.pack(">6L", *LATITUDE))
MAKER_NOTE = b"MAKERNOTE" * 3
PROFILE = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
RGB = np.random.default_rng(3).integers(0, 256, (40, 60, 3), dtype=np.uint8)


def exif():
    """Return EXIF with the settings of an exposure, and with personal data of every kind."""
    tags = Image.Exif()
    tags[0x010F] = "Maker"
    tags[0x0110] = "Model"
    tags[0x0112] = 1
    tags[0x013B] = "Ada Owner"
    settings = tags.get_ifd(0x8769)
    settings[0x829A] = 0.008
    settings[0x829D] = 5.6
    settings[0x8827] = 200
    settings[0xA431] = "SERIAL-4711"
    settings[0xA435] = "LENS-0815"
    settings[0x927C] = MAKER_NOTE
    settings[0x9286] = b"home address"
    settings[0xA434] = "50 mm"
    tags.get_ifd(0x8825).update({1: "N", 2: (51.0, 30.0, 4711 / 13), 3: "W", 4: (1.0, 2.0, 3.0)})
    return tags


def exif_block():
    """Return EXIF as a TIFF block."""
    return exif().tobytes().removeprefix(b"Exif\0\0")


def save(kind, **options):
    if kind == "AVIF":
        require_avif()
    file = io.BytesIO()
    Image.fromarray(RGB).save(file, kind, exif=exif(), **options)
    return file.getvalue()


def jpeg(**options):
    return save("JPEG", comment=b"home address", xmp=XMP, **options) + b"HIDDEN" + exif_block()


def png():
    text = PngInfo()
    text.add_text("Comment", "home address")
    text.add_itxt("XML:com.adobe.xmp", XMP.decode())
    return save("PNG", pnginfo=text) + b"HIDDEN"


def heic():
    pillow_heif = pytest.importorskip("pillow_heif", reason="HEIC needs the extra `heic`")
    image = pillow_heif.from_bytes("RGB", RGB.shape[1::-1], RGB.tobytes())
    file = io.BytesIO()
    image.save(file, quality=-1, exif=exif().tobytes(), xmp=XMP)
    return file.getvalue()


def box(kind, *contents):
    content = b"".join(contents)
    return struct.pack(">L4s", len(content) + 8, kind) + content


def jxl(*, compressed):
    codestream = imagecodecs.jpegxl_encode(RGB, lossless=True, usecontainer=False)
    tags = bytes(4) + exif_block()
    boxes = box(b"Exif", tags) + box(b"xml ", XMP)
    if compressed:
        boxes = box(b"brob", b"Exif", imagecodecs.brotli_encode(tags))
        boxes += box(b"brob", b"xml ", imagecodecs.brotli_encode(XMP))
    signature = box(b"JXL ", b"\r\n\x87\n") + box(b"ftyp", b"jxl \0\0\0\0jxl ")
    return signature + boxes + box(b"jxlc", codestream)


def tiff_directory(entries, offset, next_offset=0):
    """Return a directory of (tag, type, count, value), followed by its values."""
    table = struct.pack("<H", len(entries))
    values = b""
    values_offset = offset + 2 + 12 * len(entries) + 4
    for tag, value_type, count, value in sorted(entries):
        cell = value.ljust(4, b"\0")
        if len(value) > 4:
            cell = struct.pack("<L", values_offset + len(values))
            values += value + bytes(len(value) % 2)
        table += struct.pack("<HHL", tag, value_type, count) + cell
    return table + struct.pack("<L", next_offset) + values


def with_personal_data(data, *more_entries):
    """Return a TIFF file with EXIF, a position and personal tags added to its first directory."""
    (first,) = struct.unpack_from("<L", data, 4)
    (count,) = struct.unpack_from("<H", data, first)
    cells = []
    for offset in range(first + 2, first + 2 + 12 * count, 12):
        tag, value_type, length = struct.unpack_from("<HHL", data, offset)
        if tag not in (0x010F, 0x0110, 0x8769):
            cells.append((tag, value_type, length, data[offset + 8 : offset + 12]))
    settings = [
        (0x829A, 5, 1, struct.pack("<2L", 1, 125)),
        (0x829D, 5, 1, struct.pack("<2L", 56, 10)),
        (0x8827, 3, 1, struct.pack("<H", 200)),
        (0xA431, 2, 12, b"SERIAL-4711\0"),
        (0xA434, 2, 6, b"50 mm\0"),
        (0xA435, 2, 10, b"LENS-0815\0"),
        (0x927C, 7, len(MAKER_NOTE), MAKER_NOTE),
    ]
    position = [(1, 2, 2, b"N\0"), (2, 5, 3, struct.pack("<6L", *LATITUDE))]
    data += bytes(len(data) % 2)
    for tag, entries in ((0x8769, settings), (0x8825, position)):
        cells.append((tag, 4, 1, struct.pack("<L", len(data))))
        data += tiff_directory(entries, len(data))
    longer = [
        (0x010F, 2, 6, b"Maker\0"),
        (0x0110, 2, 6, b"Model\0"),
        (0x013B, 2, 10, b"Ada Owner\0"),
    ]
    longer += [(0x02BC, 1, len(XMP), XMP), *more_entries]
    kept_tags = {cell[0] for cell in longer}
    cells = [cell for cell in cells if cell[0] not in kept_tags]
    directory = tiff_directory([*cells, *longer], len(data))
    return data[:4] + struct.pack("<L", len(data)) + data[8:] + directory


def tiff(*more_entries):
    file = io.BytesIO()
    tifffile.imwrite(file, RGB, photometric="rgb", metadata=None)
    return with_personal_data(file.getvalue(), *more_entries)


def dng():
    """Return a DNG that LibRaw reads: the camera's colors without a mosaic."""
    identity = [n for value in np.eye(3, dtype=int).ravel().tolist() for n in (value, 1)]
    tags = [
        (50706, "B", 4, (1, 4, 0, 0), True),
        (50708, "s", 0, "Ours", True),
        (50714, "H", 3, (0, 0, 0), True),
        (50717, "H", 3, (65535, 65535, 65535), True),
        (50721, "2i", 9, identity, True),
        (50728, "2I", 3, (1, 1, 1, 1, 1, 1), True),
        (50778, "H", 1, 21, True),
    ]
    file = io.BytesIO()
    deep = RGB.astype(np.uint16) * 257
    tifffile.imwrite(file, deep, photometric=34892, extratags=tags, metadata=None)
    return with_personal_data(file.getvalue(), (0xC62F, 2, 12, b"SERIAL-4711\0"))


def preview():
    """Return a JPEG as RAW files embed it, with EXIF and XMP."""
    return save("JPEG", xmp=XMP)


def raf():
    jpeg_offset = 160
    header = b"FUJIFILMCCD-RAW 0201FF129502X-T3".ljust(84, b"\0")
    header += struct.pack(">2L", jpeg_offset, len(preview()))
    return header.ljust(jpeg_offset, b"\0") + preview() + b"SENSOR" * 50


def rw2():
    embedded = preview()
    data = tiff((0x002E, 7, len(embedded), embedded))
    return b"IIU\0" + data[4:] + b"SENSOR" * 50


def orf():
    return b"IIRO" + tiff()[4:] + b"SENSOR" * 50


def cr3():
    image = [(0x010F, 2, 6, b"Maker\0"), (0x013B, 2, 10, b"Ada Owner\0")]
    settings = [(0x829A, 5, 1, struct.pack("<2L", 1, 125)), (0xA431, 2, 12, b"SERIAL-4711\0")]
    position = [(2, 5, 3, struct.pack("<6L", *LATITUDE))]
    blocks = []
    for kind, entries in ((b"CMT1", image), (b"CMT2", settings), (b"CMT4", position)):
        blocks.append(box(kind, b"II*\0\x08\0\0\0", tiff_directory(entries, 8)))
    canon = box(b"uuid", bytes.fromhex("85c0b687820f11e08111f4ce462b6a48"), *blocks)
    xmp = box(b"uuid", bytes.fromhex("be7acfcb97a942e89c71999491e3afac"), XMP)
    movie = box(b"moov", canon)
    return box(b"ftyp", b"crx \0\0\0\1crx isom") + movie + xmp + box(b"mdat", b"SENSOR" * 50)


# Files that hdrlab decodes: pixels and exposure are compared.
PHOTOS = {
    "plain.jpg": jpeg,
    "progressive.jpg": lambda: jpeg(progressive=True),
    "restarts.jpg": lambda: jpeg(restart_marker_rows=1),
    "profile.JPEG": lambda: jpeg(quality=50, icc_profile=PROFILE),
    "a.png": png,
    "a.tif": tiff,
    "lossy.webp": lambda: save("WEBP", xmp=XMP),
    "lossless.webp": lambda: save("WEBP", xmp=XMP, lossless=True),
    "a.avif": lambda: save("AVIF", xmp=XMP),
    "a.heic": heic,
    "a.jxl": lambda: jxl(compressed=False),
    "brotli.jxl": lambda: jxl(compressed=True),
    "a.dng": dng,
}
# The structure of RAW files, with a block of bytes where the sensor values are.
RAW_STRUCTURES = {
    "a.raf": raf,
    "a.rw2": rw2,
    "a.orf": orf,
    "a.cr3": cr3,
    "a.nef": tiff,
    "a.cr2": tiff,
}
EVERY_FILE = PHOTOS | RAW_STRUCTURES


def has_personal_data(data):
    secrets = [secret for secret in SECRETS if secret in data]
    return secrets + [packed for packed in PACKED_LATITUDES if packed in data]


@pytest.mark.parametrize("name", EVERY_FILE)
def test_no_location_serial_number_or_owner_remains(name):
    before = EVERY_FILE[name]()
    assert has_personal_data(before) or name == "brotli.jxl"
    after = metadata.strip_metadata(name, before)
    assert has_personal_data(after.data) == []
    assert {"location", "serial numbers"} <= after.removed


@pytest.mark.parametrize("name", PHOTOS)
def test_pixels_exposure_and_camera_are_unchanged(name, tmp_path):
    if name == "a.dng":
        pytest.importorskip("rawpy", reason="the pixels of a DNG need the extra `raw`")
    (tmp_path / "before").mkdir()
    before = tmp_path / "before" / name
    before.write_bytes(PHOTOS[name]())
    after = tmp_path / name
    after.write_bytes(metadata.strip_metadata(before).data)
    assert np.array_equal(read_photo(before), read_photo(after))
    exposure = read_header(after).exposure
    assert exposure.seconds == pytest.approx(1 / 125)
    assert exposure.f_number == pytest.approx(5.6)
    assert exposure.iso == 200
    assert b"Model" in after.read_bytes()
    assert b"50 mm" in after.read_bytes()


@pytest.mark.parametrize("name", RAW_STRUCTURES)
def test_a_raw_file_keeps_its_layout_and_its_sensor_values(name):
    before = RAW_STRUCTURES[name]()
    after = metadata.strip_metadata(name, before).data
    assert len(after) == len(before)
    assert after[-300:] == before[-300:] or not before.endswith(b"SENSOR")


@pytest.mark.parametrize("name", EVERY_FILE)
def test_a_clean_file_stays_as_it_is(name):
    once = metadata.strip_metadata(name, EVERY_FILE[name]())
    again = metadata.strip_metadata(name, once.data)
    assert again.data == once.data
    assert again.removed == frozenset()


@pytest.mark.parametrize("name", ["a.dng", *RAW_STRUCTURES])
def test_maker_notes_of_raw_files_stay_and_the_result_says_so(name):
    after = metadata.strip_metadata(name, EVERY_FILE[name]())
    assert "maker notes" in after.remaining
    assert name == "a.cr3" or MAKER_NOTE in after.data


@pytest.mark.parametrize("name", [name for name in PHOTOS if name != "a.dng"])
def test_maker_notes_of_other_photos_are_removed(name):
    after = metadata.strip_metadata(name, PHOTOS[name]())
    assert MAKER_NOTE not in after.data
    assert after.remaining == ""


@pytest.mark.parametrize("name", EVERY_FILE)
def test_exiftool_finds_no_personal_data(name, tmp_path):
    if shutil.which("exiftool") is None:
        pytest.skip("exiftool is not installed")
    path = tmp_path / name
    path.write_bytes(metadata.strip_metadata(name, EVERY_FILE[name]()).data)
    output = subprocess.run(["exiftool", "-json", "-a", path], capture_output=True, check=False)
    (tags,) = json.loads(output.stdout)
    personal = ("GPS", "SerialNumber", "Artist", "Owner", "UserComment")
    assert [tag for tag in tags if any(word in tag for word in personal)] == []


def test_a_color_profile_is_kept():
    data = PHOTOS["profile.JPEG"]()
    assert PROFILE in metadata.strip_metadata("a.jpg", data).data


def test_a_film_inside_a_heic_file_is_blanked():
    data = heic() + box(b"mpvd", b"film with HIDDEN place")
    after = metadata.strip_metadata("a.heic", data).data
    assert len(after) == len(data)
    assert has_personal_data(after) == []


def test_bytes_between_two_segments_are_refused():
    data = PHOTOS["plain.jpg"]()
    scan = data.index(b"\xff\xda")
    pixels = scan + 2 + int.from_bytes(data[scan + 2 : scan + 4])
    smuggled = data[:pixels] + b"\xff\xfe\0\4hi" + b"at home" + data[pixels:]
    with pytest.raises(ValueError, match=r"a\.jpg"):
        metadata.strip_metadata("a.jpg", smuggled)


def test_a_copy_of_the_location_in_an_unknown_place_is_refused():
    data = dng() + PACKED_LATITUDES[1]
    with pytest.raises(ValueError, match=r"a\.dng.*location"):
        metadata.strip_metadata("a.dng", data)


@pytest.mark.parametrize("name", ["a.heic", "a.cr3", "a.txt", "a.raf", "a.gif"])
def test_a_file_that_cannot_be_cleaned_is_refused_by_name(name):
    for data in (b"\0\0\0 ftypheic" + bytes(100), b"GIF89a" + bytes(100), b""):
        with pytest.raises(ValueError, match=name):
            metadata.strip_metadata(name, data)


@given(st.sampled_from(sorted(EVERY_FILE)), st.data())
def test_a_damaged_file_is_refused_or_cleaned(name, data):
    whole = bytearray(EVERY_FILE[name]())
    whole[data.draw(st.integers(0, len(whole) - 1))] = data.draw(st.integers(0, 255))
    cut = data.draw(st.integers(1, len(whole)))
    with contextlib.suppress(ValueError):
        metadata.strip_metadata(name, bytes(whole[:cut]))
