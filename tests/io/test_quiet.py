"""Messages of C libraries about damaged files are hidden; all other messages are shown."""

import base64
import os
import subprocess
import sys
import warnings
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import OpenEXR
import pytest
from PIL import Image

from hdrlab.core.silence import ignore_library_warnings
from hdrlab.io.maps import exr
from hdrlab.io.photos import read_photo

# its pixels refer to some before the first: the codec warns of it
DAMAGED_PNG = (
    "iVBORw0KGgoAAAANSUhEUgAAABEAAAAMCAAAAAChTgljAAAAsElEQVR4nGOsD5uc9nY+AwMDAwOD+D9hcQGmH0v1+39DBBhc"
    "rbgj/zEZey1jgYnMuDTf6QbLLqa/X/ZBRaxv911/ziT1KPWfFFREWPPKEVYmEbePu2WhIlwP9uvrM4b9+qQocR8iIvRIRV2R"
    "6Zni8ypJqJp/bOK39zDlGAis2AwVEb0u+/Qt0yMVr/0GUBGFjjUPw5j+1Lx4FQsV6bsfI5nOwv5X16qGCyLSyL7e6awAzqY8"
    "SSqB17EAAAAASUVORK5C"
)


def damaged_exr(path):
    """Write an OpenEXR file with a wrong row number, for which the library prints an error."""
    header = {"type": OpenEXR.scanlineimage, "compression": OpenEXR.NO_COMPRESSION}
    with OpenEXR.File(header, {"RGB": np.ones((9, 5, 3), np.float32)}) as file:
        file.write(str(path))
    data = bytearray(path.read_bytes())
    data[-5 * 12 - 8 : -5 * 12 - 4] = b"\x7f\0\0\0"
    path.write_bytes(data)


def test_reading_a_damaged_map_prints_nothing_of_the_codecs(tmp_path, capfd):
    damaged_exr(tmp_path / "x.exr")
    with pytest.raises(ValueError, match=r"x\.exr"):
        exr.read(tmp_path / "x.exr")
    os.write(2, b"of ours")
    assert capfd.readouterr() == ("", "of ours")


def test_reading_a_damaged_photo_prints_nothing_of_the_codecs(tmp_path):
    (tmp_path / "x.png").write_bytes(base64.b64decode(DAMAGED_PNG))
    read = "import sys; from hdrlab.io.photos import read_photo; read_photo(sys.argv[1])"
    command = [sys.executable, "-c", read, str(tmp_path / "x.png")]
    stderr = subprocess.run(command, capture_output=True, text=True).stderr
    assert "x.png: it is cut short" in stderr and "PNG warning" not in stderr


def test_reading_photos_in_threads_leaves_the_filters_of_warnings_as_they_were(tmp_path):
    path = tmp_path / "x.jpg"
    Image.fromarray(np.full((8, 8, 3), 90, np.uint8)).save(path)
    before = list(warnings.filters)
    with ThreadPoolExecutor(8) as pool:
        list(pool.map(lambda _: read_photo(path), range(400)))
    assert list(warnings.filters) == before


def test_warnings_of_other_packages_are_shown_while_photos_are_read():
    with ignore_library_warnings(), pytest.warns(UserWarning, match="ours"):
        warnings.warn("ours", stacklevel=1)
