"""A damaged file is read, or it raises an HdrlabError or OSError."""

from functools import partial
from pathlib import Path

import numpy as np
import OpenEXR
import pytest
import tifffile
from hypothesis import HealthCheck, given, settings, strategies as st
from PIL import Image

from hdrlab.errors import HdrlabError
from hdrlab.io.maps import rgbe
from hdrlab.io.photos import read_photo
from hdrlab.io.radiance import SUFFIXES, read_radiance, write_radiance
from hdrlab.show.describe import describe_file

RGB = np.random.default_rng(0).integers(0, 256, (12, 17, 3), np.uint8)
RGB[:, 5:12] = 90
E = (RGB / 255).astype(np.float32)


def _exif():
    tags = Image.Exif()
    tags[0x0112] = 6
    tags.get_ifd(0x8769).update({33434: 0.5, 33437: 8.0, 34855: 100})
    return tags


def _exr(path, **header):
    with OpenEXR.File({"type": OpenEXR.scanlineimage, **header}, {"RGB": E}) as file:
        file.write(str(path))


def _flat(path):
    path.write_bytes(b"#?RADIANCE\nEXPOSURE=2\n\n-Y 12 +X 17\n" + rgbe.to_pixels(E).tobytes())


WRITERS = {
    "coded.hdr": lambda path: write_radiance(path, E),
    "flat.hdr": _flat,
    "x.pfm": lambda path: write_radiance(path, E),
    "zip.exr": lambda path: _exr(path, compression=OpenEXR.ZIP_COMPRESSION),
    "piz.exr": lambda path: _exr(path, compression=OpenEXR.PIZ_COMPRESSION),
    "raw.exr": lambda path: _exr(path, compression=OpenEXR.NO_COMPRESSION),
    "x.png": lambda path: Image.fromarray(RGB).save(path, exif=_exif()),
    "x.jpg": lambda path: Image.fromarray(RGB).save(path, exif=_exif()),
    "progressive.jpg": lambda path: Image.fromarray(RGB).save(path, progressive=True),
    "float.tif": lambda path: write_radiance(path, E),
    "x.tif": lambda path: Image.fromarray(RGB).save(path, exif=_exif()),
    "deflated.tif": lambda path: tifffile.imwrite(
        path, RGB, photometric="rgb", compression="deflate"
    ),
}


PHOTOGRAPHS = ("x.tif", "deflated.tif")  # which may be maps by their names


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return a folder with a good file of each kind."""
    folder = tmp_path_factory.mktemp("damaged")
    for name, write in WRITERS.items():
        write(folder / name)
    return folder


def reader_of(name):
    return read_photo if Path(name).suffix not in SUFFIXES or name in PHOTOGRAPHS else read_radiance


places = st.one_of(st.integers(0, 400), st.integers(0, 4000))
changes = st.lists(
    st.tuples(places, st.one_of(st.sampled_from([0, 1, 2, 127, 128, 255]), st.integers(0, 255))),
    max_size=6,
)


@pytest.mark.parametrize("name", WRITERS)
@given(
    changes=changes,
    length=st.one_of(st.none(), places),
    inserted=st.tuples(places, st.binary(max_size=8)),
)
@settings(
    max_examples=60, deadline=20_000, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_damaged_files_are_read_or_rejected(folder, name, changes, length, inserted):
    data = bytearray((folder / name).read_bytes())
    for place, value in changes:
        data[place % len(data)] = value
    at, more = inserted
    data[at % len(data) : at % len(data)] = more
    path = folder / f"damaged-{name}"
    path.write_bytes(data[:length])
    pixels = reader_of(name)
    if pixels is read_radiance:
        pixels = partial(read_radiance, clean=True)
    for read in (pixels, describe_file):
        try:
            read(path)
        except (HdrlabError, OSError) as error:
            assert path.name in str(error)


@pytest.mark.parametrize("name", WRITERS)
@given(data=st.binary(max_size=300))
@settings(
    max_examples=30, deadline=20_000, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_random_bytes_after_a_valid_beginning_are_read_or_rejected(folder, name, data):
    path = folder / f"begun-{name}"
    path.write_bytes((folder / name).read_bytes()[:60] + data)
    try:
        reader_of(name)(path)
    except (HdrlabError, OSError) as error:
        assert path.name in str(error)
