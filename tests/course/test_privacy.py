"""Photographs are handed in without where and by which camera they were taken; their pixels are the same."""

import contextlib
import io
import struct

import numpy as np
import pytest
from hypothesis import given, strategies as st
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from hdrlab.course.projects import exif as parts, privacy
from hdrlab.io.decode import look

SECRETS = (
    b"SERIAL-4711",
    b"LENS-0815",
    b"Ada Owner",
    b"MAKERNOTE",
    b"gps:51.5N",
    b"home address",
    b"THUMB",
)
NUMBERS = [struct.pack(f"{s}LL", *pair) for s in "<>" for pair in ((51, 1), (4711, 13))]


def exif():
    """Return EXIF with a setting, and with all that tells."""
    made = Image.Exif()
    made[0x010F], made[0x0110], made[0x013B], made[0x0112] = "Maker", "Model", "Ada Owner", 1
    inner = made.get_ifd(0x8769)
    inner[0x829A], inner[0x829D], inner[0x8827] = 0.008, 5.6, 200
    inner[0xA431], inner[0xA435], inner[0x927C] = "SERIAL-4711", "LENS-0815", b"MAKERNOTE" * 3
    inner[0x9286], inner[0xA434] = b"home address", "50 mm"
    made.get_ifd(0x8825).update({1: "N", 2: (51.0, 30.0, 4711 / 13), 3: "W"})
    return made


def picture(shape=(40, 60, 3)):
    return Image.fromarray(np.random.default_rng(3).integers(0, 256, shape, dtype=np.uint8))


def jpeg(**knobs):
    file = io.BytesIO()
    picture().save(
        file, "JPEG", exif=exif(), comment=b"home address", xmp=b"<x gps:51.5N GPS/>", **knobs
    )
    return file.getvalue() + b"THUMB" + exif().tobytes()


def png():
    file, info = io.BytesIO(), PngInfo()
    info.add_text("Comment", "home address")
    info.add_itxt("XML:com.adobe.xmp", "gps:51.5N GPS")
    picture().save(file, "PNG", exif=exif(), pnginfo=info)
    return file.getvalue() + b"THUMB"


def tiff():
    """Return a TIFF with directories of settings and of a position, behind the pixels."""
    file = io.BytesIO()
    picture().save(file, "TIFF")
    data, sign = file.getvalue(), "<"
    given = parts.directory(data, parts.first(data), sign)[0]
    tags = exif()
    tags.endian = sign
    block = tags.tobytes()[6:]
    entries = parts.directory(block, parts.first(block), parts.order(block))[0]
    for tag in (parts.POINTER, parts.POSITION):
        inner = sorted(parts.pointed(block, entries, tag))
        given.append(parts.Entry(tag, 4, 1, struct.pack("<L", len(data)), 0))
        data += parts._written(inner, len(data), sign)
    given += [one for one in entries if one.tag in (0x010F, 0x0110, 0x013B)]
    given.append(parts.Entry(0x02BC, 1, 14, b"<x gps:51.5N/>", 0))
    return (
        data[:4]
        + struct.pack("<L", len(data))
        + data[8:]
        + parts._written(sorted(given), len(data), sign)
    )


FILES = {
    "plain.jpg": jpeg(),
    "progressive.jpg": jpeg(progressive=True),
    "restarts.jpg": jpeg(restart_marker_rows=1),
    "gray.JPEG": jpeg(quality=50, icc_profile=b"profile" * 30),
    "a.png": png(),
    "a.tif": tiff(),
}


def pixels(data):
    return np.asarray(Image.open(io.BytesIO(data)))


@pytest.mark.parametrize("name", FILES)
def test_nothing_tells_where_and_by_which_camera(name):
    before = FILES[name]
    assert any(secret in before for secret in SECRETS) and any(
        number in before for number in NUMBERS
    )
    after = privacy.clean(name, before)
    assert not [secret for secret in SECRETS if secret in after.data]
    assert not [number for number in NUMBERS if number in after.data]
    assert {"location", "serial numbers"} <= after.removed and not after.remains
    with Image.open(io.BytesIO(after.data)) as image:
        assert not dict(image.getexif().get_ifd(0x8825))


@pytest.mark.parametrize("name", FILES)
def test_pixels_are_the_same_to_the_bit(name):
    assert np.array_equal(pixels(FILES[name]), pixels(privacy.clean(name, FILES[name]).data))


@pytest.mark.parametrize("name", FILES)
def test_what_the_exposure_was_is_kept(name, tmp_path):
    (tmp_path / name).write_bytes(privacy.clean(name, FILES[name]).data)
    seconds, f_number, iso = look(tmp_path / name).exposure
    assert (round(seconds, 6), round(f_number, 3), iso) == (0.008, 5.6, 200)
    with Image.open(tmp_path / name) as image:
        tags = image.getexif()
        assert tags[0x0110] == "Model" and tags.get_ifd(0x8769)[0xA434] == "50 mm"


def test_a_colour_profile_is_kept():
    assert b"profile" * 30 in privacy.clean("a.jpg", FILES["gray.JPEG"]).data


def test_nothing_hides_behind_a_segment_that_goes():
    data = FILES["plain.jpg"]
    at = data.index(b"\xff\xda")
    at += 2 + int.from_bytes(data[at + 2 : at + 4])  # where coded pixels begin
    with pytest.raises(ValueError, match="expected a marker of JPEG"):
        privacy.clean("a.jpg", data[:at] + b"\xff\xfe\0\4hi" + b"at home" + data[at:])


@pytest.mark.parametrize("name", FILES)
def test_what_is_clean_stays_as_it_is(name):
    once = privacy.clean(name, FILES[name]).data
    assert privacy.clean(name, once).data == once


def test_a_raw_file_keeps_its_makers_notes_and_that_is_said():
    after = privacy.clean("a.dng", FILES["a.tif"])
    assert b"MAKERNOTE" in after.data and "serial number" in after.remains
    assert not any(secret in after.data for secret in (b"SERIAL-4711", b"LENS-0815", b"gps:51.5N"))
    assert np.array_equal(pixels(FILES["a.tif"]), pixels(after.data))


@pytest.mark.parametrize("name", ["a.heic", "a.cr3", "a.txt", "a.raf"])
def test_what_cannot_be_cleaned_is_refused(name):
    with pytest.raises(ValueError, match="cannot be cleaned"):
        privacy.clean(name, b"\0\0\0 ftypheic" + bytes(100))


@given(st.sampled_from(sorted(FILES)), st.data())
def test_a_damaged_file_is_refused_or_cleaned_and_never_an_accident(name, data):
    whole = bytearray(FILES[name])
    whole[data.draw(st.integers(0, len(whole) - 1))] = data.draw(st.integers(0, 255))
    cut = data.draw(st.integers(1, len(whole)))
    with contextlib.suppress(ValueError):
        privacy.clean(name, bytes(whole[:cut]))
