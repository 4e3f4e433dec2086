"""hdrlab.io.maps.layers: the parts of an OpenEXR file survive a round trip."""

import numpy as np
import pytest

from hdrlab.errors import InputError
from hdrlab.io import radiance
from hdrlab.io.maps import exr
from hdrlab.io.maps.layers import read_layers, write_layers

RNG = np.random.default_rng(1)
RGB = RNG.random((5, 7, 3)).astype(np.float32)
GRAY = RNG.random((5, 7)).astype(np.float32)
RGBA = RNG.random((5, 7, 4)).astype(np.float32)


def test_layers_survive_a_round_trip_bit_for_bit_with_infinity(tmp_path):
    s = GRAY.copy()
    s[2, 3] = np.inf
    layers = {"radiance": RGB, "standard deviation": s, "cover": RGBA}
    write_layers(tmp_path / "a.exr", layers, comments=["one", "two"])
    read_back = read_layers(tmp_path / "a.exr")
    assert list(read_back) == list(layers)
    assert all(np.array_equal(read_back[name], layers[name]) for name in layers)
    assert exr.read_header(tmp_path / "a.exr").attributes["comments"] == "one\ntwo"


def test_programs_without_layers_read_the_first_layer(tmp_path):
    write_layers(tmp_path / "a.exr", {"radiance": RGB, "standard deviation": 0 * RGB})
    assert np.array_equal(radiance.read_radiance(tmp_path / "a.exr"), RGB)


@pytest.mark.parametrize(
    "layers",
    [{}, {"a": RGB, "b": GRAY[:3]}, {"a": RGB[0, 0]}, {"a": RGB[..., :2]}, {"a": np.zeros((0, 3))}],
)
def test_write_layers_rejects_bad_layers_and_keeps_the_old_file(layers, tmp_path):
    path = tmp_path / "a.exr"
    write_layers(path, {"radiance": RGB})
    before = path.read_bytes()
    with pytest.raises(InputError):
        write_layers(path, layers)
    assert path.read_bytes() == before and [file.name for file in tmp_path.iterdir()] == ["a.exr"]
