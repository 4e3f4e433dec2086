"""With NumPy, SciPy and Pillow only, photos become a map and an image; an error names other packages."""

import subprocess
import sys

import imagecodecs
import numpy as np
import pytest
from PIL import Image

import hdrlab
from hdrlab.io import codecs

ALONE = """
import sys
from importlib.machinery import PathFinder

class Finder:
    '''Finds the three packages and what Python brings, and no other package.'''

    @staticmethod
    def find_spec(name, path=None, target=None):
        known = {"hdrlab", "numpy", "scipy", "PIL"} | sys.stdlib_module_names
        if path is not None or name in known or name.startswith("_"):
            return PathFinder.find_spec(name, path, target)

sys.meta_path[:] = [*sys.meta_path[: sys.meta_path.index(PathFinder)], Finder]
"""
PIPELINE = """
import numpy as np
from hdrlab.io import photos, radiance
from hdrlab.pipeline import assemble, develop

assembly = assemble(photos.read_bracket("photos", [1, 1 / 4, 1 / 16]))
radiance.write_radiance("room.pfm", assembly.E)
photos.write_picture("room.png", develop(radiance.read_radiance("room.pfm"), "reinhard"))
print(photos.read_photo("room.png").shape, assembly.g.shape, bool(np.isfinite(assembly.E).all()))
"""
PARTS = {
    "hdrlab.io.photos.read_photo('a.tif')": "tifffile",
    "hdrlab.io.photos.read_photo('deep.png')": "imagecodecs",
    "hdrlab.io.sequence.write('a.gif', np.zeros((2, 2, 2), np.uint8))": "imageio",
    "hdrlab.core.filters.warp.sample(np.ones((9, 9)), np.eye(3), (9, 9))": "scikit-image",
    "import_module('hdrlab.show.plots')": "matplotlib",
    "import_module('hdrlab.show.widgets')": "anywidget",
}
EACH = f"""
from importlib import import_module
import numpy as np
import hdrlab
import hdrlab.io.photos, hdrlab.io.radiance, hdrlab.core.filters.warp, hdrlab.io.sequence
for part in {list(PARTS)!r}:
    try:
        print("nothing is missing", eval(part))
    except ModuleNotFoundError as error:
        print(error)
"""


def alone(code, folder):
    """Return what a process of its own prints in which only the three packages can be imported."""
    words = [sys.executable, "-c", ALONE + code]
    ran = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    return ran.stdout


@pytest.fixture
def photographs(tmp_path):
    """A folder with `photos`, three JPEG files of a ramp."""
    (tmp_path / "photos").mkdir()
    ramp = np.broadcast_to(np.linspace(2, 2000, 96)[:, None], (96, 64))
    for stops in range(3):
        levels = np.clip(ramp / 4**stops, 0, 255).astype(np.uint8)
        Image.fromarray(levels).convert("RGB").save(
            tmp_path / "photos" / f"{stops}.jpg", quality=95
        )
    return tmp_path


def test_photographs_become_a_map_and_a_picture(photographs):
    assert alone(PIPELINE, photographs) == "(96, 64, 3) (256, 3) True\n"


def test_scenes_and_the_formats_of_radiance_maps_need_no_other_package(tmp_path):
    code = """
from hdrlab import scenes
from hdrlab.io import radiance

E = scenes.chapel()[:40, :60]
for name in ("a.exr", "a.hdr"):
    radiance.write_radiance(name, E)
    print(radiance.read_radiance(name).shape)
"""
    assert alone(code, tmp_path) == "(40, 60, 3)\n" * 2


def test_a_part_that_needs_another_package_says_which_to_install(tmp_path):
    (tmp_path / "deep.png").write_bytes(imagecodecs.png_encode(np.zeros((2, 2, 3), np.uint16)))
    (tmp_path / "a.tif").write_bytes(b"II*\0" + bytes(40))
    lines = alone(EACH, tmp_path).splitlines()
    assert [
        (part, package in line) for (part, package), line in zip(PARTS.items(), lines, strict=True)
    ] == [(part, True) for part in PARTS], lines


@pytest.mark.parametrize("form", ["JPEG", "PNG"])
def test_pillow_decodes_what_imagecodecs_does(form, tmp_path):
    picture = np.random.default_rng(0).integers(0, 256, (40, 50, 3)).astype(np.uint8)
    Image.fromarray(picture).save(tmp_path / "a", form)
    data = (tmp_path / "a").read_bytes()
    assert np.array_equal(codecs.decode_by_pillow(data), codecs.DECODERS[form](data, None))


def test_chapters_are_attributes_of_hdrlab_and_unknown_names_raise_an_error():
    assert hdrlab.tonemap.__name__ == "hdrlab.tonemap" and "pipeline" in dir(hdrlab)
    with pytest.raises(AttributeError, match="no attribute 'cooking'"):
        hdrlab.cooking  # noqa: B018
